// SPDX-License-Identifier: MIT

#pragma once

#include "lib/result.hpp"

#include <dlfcn.h>

namespace kb
{

/// A library opened by name at run time. It stays open until the process ends: Mesa's threads and
/// exit handlers outlive the last context.
class SharedLibrary
{
public:
    static Result<SharedLibrary> open(const char *name)
    {
        void *handle = dlopen(name, RTLD_NOW | RTLD_GLOBAL);
        if (!handle)
            return Error{std::string("cannot open ") + dlerror()};
        return SharedLibrary(handle);
    }

    template <class Function>
    bool load(Function &function, const char *name) const
    {
        function = reinterpret_cast<Function>(dlsym(handle_, name));
        return function != nullptr;
    }

private:
    explicit SharedLibrary(void *handle) : handle_(handle) {}

    void *handle_;
};

} // namespace kb
