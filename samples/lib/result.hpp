// SPDX-License-Identifier: MIT
//
// A value, or a message that says why there is none. Everything that can go wrong because of input
// (files, command lines, drivers) returns one; exceptions are for mistakes of the program itself.

#pragma once

#include <string>
#include <utility>
#include <variant>

namespace kb
{

struct Error {
    std::string message; ///< One line, without a full stop, fit to follow "program: ".
};

template <class T>
class [[nodiscard]] Result
{
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    explicit operator bool() const { return state_.index() == 0; }

    T &operator*() & { return std::get<0>(state_); }
    const T &operator*() const & { return std::get<0>(state_); }
    T &&operator*() && { return std::get<0>(std::move(state_)); }
    T *operator->() { return &std::get<0>(state_); }
    const T *operator->() const { return &std::get<0>(state_); }

    const Error &error() const { return std::get<1>(state_); }

private:
    std::variant<T, Error> state_;
};

/// The result of an action that gives nothing but success.
using Status = Result<std::monostate>;
inline constexpr std::monostate ok{};

} // namespace kb
