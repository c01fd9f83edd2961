// SPDX-License-Identifier: MIT
//
// The kinds of context, for make_context alone.

#pragma once

#include "lib/gl/context.hpp"

namespace kb
{

Result<std::unique_ptr<Context>> make_osmesa_context();
Result<std::unique_ptr<Context>> make_egl_context();
Result<std::unique_ptr<Context>> make_glfw_context(Size size, const std::string &title);

} // namespace kb
