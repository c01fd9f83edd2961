#!/usr/bin/env python3
# Copyright © 2026 The mesa-kbuffer authors
# SPDX-License-Identifier: MIT
"""mkprofile.py SOURCE_DIR BUILD_DIR SHADER_RUNNER OUT.xml.gz [LAUNCHER...]

Writes a piglit profile of this folder: a test for each SOURCE_DIR/gl/*.c of
which there is a program in BUILD_DIR/bin, and for each
SOURCE_DIR/shaders/*.shader_test, by absolute paths, so that any piglit's `run`
can execute them; LAUNCHER goes in front of each."""
import glob
import gzip
import os
import sys
import xml.etree.ElementTree as et


def tests(source, build, runner):
    # BUILD_DIR/bin may still have tests that are no longer there.
    for path in sorted(glob.glob(source + '/gl/*.c')):
        name = os.path.basename(path)[:-len('.c')]
        program = os.path.abspath(f'{build}/bin/{name}')
        if os.access(program, os.X_OK):
            yield name, [program]
    for path in sorted(glob.glob(source + '/shaders/*.shader_test')):
        name = os.path.basename(path)[:-len('.shader_test')]
        yield name, [os.path.abspath(runner), os.path.abspath(path)]


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    source, build, runner, out, *launcher = sys.argv[1:]
    found = list(tests(source, build, runner))
    root = et.Element('PiglitTestList', count=str(len(found)), name='kbuffer')
    for name, command in found:
        extension = 'depth_peeling' if name.startswith('peel-') else \
            'kbuffer_program'
        test = et.SubElement(root, 'Test', type='gl',
                             name=f'spec@mesa_{extension}@{name}')
        et.SubElement(test, 'option', name='command', value=repr(launcher + command))
        # What may run beside others piglit starts with -fbo.
        et.SubElement(test, 'option', name='run_concurrent',
                      value=str(not name.endswith('-window')))
    with gzip.open(out, 'wb') as file:
        et.ElementTree(root).write(file, encoding='utf-8',
                                   xml_declaration=True)


main()
