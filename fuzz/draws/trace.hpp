// SPDX-License-Identifier: MIT
//
// Makes GL calls and, where it is asked to, writes them down as C.

#pragma once

#include "fuzz/offscreen.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <type_traits>

namespace kb::fuzz
{

/// An enum with its name. GL_NAMED(GL_LESS) makes one.
struct Named {
    GLenum value = 0;
    const char *name = "0";
};
#define GL_NAMED(name)                                                                             \
    kb::fuzz::Named                                                                                \
    {                                                                                              \
        name, #name                                                                                \
    }

class Trace
{
public:
    explicit Trace(std::FILE *file) : file_(file) {}

    template <class Result, class... Parameters, class... Args>
    Result call(const char *name, Result (*function)(Parameters...), const Args &...args)
    {
        static_assert(sizeof...(Parameters) == sizeof...(Args));
        if (file_) {
            std::string text;
            ((text += (text.empty() ? "" : ", ") + show(args)), ...);
            fmt::print(file_, "{}({});\n", name, text);
            std::fflush(file_); // The next call may be the last.
        }
        return function(static_cast<Parameters>(plain(args))...);
    }

    template <class... Args>
    void comment(fmt::format_string<Args...> format, Args &&...args)
    {
        if (file_)
            fmt::print(file_, "    /* {} */\n", fmt::format(format, std::forward<Args>(args)...));
    }

private:
    template <class Value>
    static std::string show(const Value &value)
    {
        if constexpr (std::is_same_v<Value, Named>)
            return value.name;
        else if constexpr (std::is_pointer_v<Value>)
            return value ? "data" : "NULL";
        else if constexpr (std::is_null_pointer_v<Value>)
            return "NULL";
        else
            return fmt::format("{}", value);
    }

    template <class Value>
    static auto plain(const Value &value)
    {
        if constexpr (std::is_same_v<Value, Named>)
            return value.value;
        else
            return value;
    }

    std::FILE *file_;
};

} // namespace kb::fuzz
