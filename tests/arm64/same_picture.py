#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""same_picture.py A.ppm B.ppm

Fails unless two pictures of the hello programs are the same but for one level of each component.

They compose constants, which are interpolated and added with an error of some 2^-20 that depends
on the machine (rounding after each operation or not), and a level is 2^-8: a component can come
to lie on the other side of the limit between two levels, but not two away. Which pixels a
triangle covers is decided in integers, everywhere the same."""
import re
import sys


def read(path):
    """The header and the components"""
    with open(path, 'rb') as file:
        data = file.read()
    header = re.match(rb'P6\n(\d+) (\d+)\n255\n', data)
    if not header or len(data) != header.end() + 3 * int(header[1]) * int(header[2]):
        sys.exit(f'{path} is not a whole picture')
    return header[0], data[header.end():]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    (header, one), (other_header, other) = map(read, sys.argv[1:])
    if header != other_header:
        sys.exit('the sizes differ')
    differences = [abs(a - b) for a, b in zip(one, other)]
    print(f'{sum(d > 0 for d in differences)} components differ, by {max(differences)} at most')
    sys.exit(max(differences) > 1)


main()
