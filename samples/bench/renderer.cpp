// SPDX-License-Identifier: MIT

#include "bench/renderer.hpp"

#include <stdexcept>

namespace kb::bench
{

std::unique_ptr<Renderer> make_renderer(const Gl &gl, const std::string &method,
                                        const std::string &variant, Size size, int k)
{
    if (method == "zbuffer")
        return make_zbuffer(gl, size);
    if (method == "classic-peeling")
        return make_classic_peeling(gl, size, k);
    if (method == "dual-peeling")
        return make_dual_peeling(gl, size, k);
    if (method == "fbfetch")
        return make_fbfetch(gl, size, k);
    if (method == "linked-list")
        return make_linked_list(gl, size, k);
    if (method == "k-plus")
        return make_k_plus(gl, variant, size, k);
    if (method == "kbuffer-program")
        return make_kbuffer_program(gl, size, k);
    if (method == "depth-peeling")
        return make_depth_peeling(gl, size, k);
    throw std::invalid_argument("no method is called " + method);
}

} // namespace kb::bench
