// SPDX-License-Identifier: MIT

#include "tests/robustness/failing_allocations.hpp"

#include <elfutils/libdwfl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <memory>
#include <utility>

#include <dwarf.h>
#include <unistd.h>
#include <unwind.h>

// What does the work: AddressSanitizer's functions where it is there, else the C library's.
extern "C" {
[[gnu::weak]] void *__interceptor_malloc(std::size_t) noexcept;
[[gnu::weak]] void *__interceptor_calloc(std::size_t, std::size_t) noexcept;
[[gnu::weak]] void *__interceptor_realloc(void *, std::size_t) noexcept;
[[gnu::weak]] void *__interceptor_memalign(std::size_t, std::size_t) noexcept;
void *__libc_malloc(std::size_t) noexcept;
void *__libc_calloc(std::size_t, std::size_t) noexcept;
void *__libc_realloc(void *, std::size_t) noexcept;
void *__libc_memalign(std::size_t, std::size_t) noexcept;
}

namespace kb::test
{

namespace
{

struct Range {
    std::uintptr_t begin;
    std::uintptr_t end;
};

// Functions in the place of malloc have no other place for their state. Fixed sizes: they must not
// allocate.
struct Watch {
    std::array<Range, 256> ours{};
    std::array<Range, 64> helpers{};
    std::size_t num_ours = 0;
    std::size_t num_helpers = 0;

    std::atomic<int> countdown{-1}; ///< Allocations until one fails; negative: none does.
    std::atomic<bool> recording{false};
    std::atomic<std::uintptr_t> failed_site{0};
    std::array<std::atomic<std::uintptr_t>, 512> places{};
};
Watch watch;

bool in_any(std::span<const Range> ranges, std::uintptr_t address)
{
    return std::any_of(ranges.begin(), ranges.end(), [address](const Range &range) {
        return address >= range.begin && address < range.end;
    });
}

/// A call that leads to an allocation: a return address may already belong to what follows it.
std::uintptr_t call_site(const void *return_address)
{
    return reinterpret_cast<std::uintptr_t>(return_address) - 1;
}

/// Goes up through helpers; the site stays 0 if it is not our code that has called the last one.
_Unwind_Reason_Code visit_frame(_Unwind_Context *context, void *result)
{
    const std::uintptr_t site = _Unwind_GetIP(context) - 1;
    auto &[in_helpers, ours] = *static_cast<std::pair<bool, std::uintptr_t> *>(result);
    if (in_any(std::span(watch.helpers).first(watch.num_helpers), site)) {
        in_helpers = true;
        return _URC_NO_REASON;
    }
    if (!in_helpers) // Not yet: these are the functions of this file.
        return _URC_NO_REASON;
    if (in_any(std::span(watch.ours).first(watch.num_ours), site))
        ours = site;
    return _URC_END_OF_STACK;
}

/// The call site in our files that is responsible for an allocation, else 0.
std::uintptr_t our_site(const void *return_address)
{
    const std::uintptr_t site = call_site(return_address);
    if (in_any(std::span(watch.ours).first(watch.num_ours), site))
        return site;
    if (!in_any(std::span(watch.helpers).first(watch.num_helpers), site))
        return 0;
    std::pair<bool, std::uintptr_t> result{false, 0};
    _Unwind_Backtrace(visit_frame, &result);
    return result.second;
}

void record(std::uintptr_t site)
{
    for (auto &place : watch.places) {
        std::uintptr_t none = 0;
        if (place.compare_exchange_strong(none, site) || none == site)
            return;
    }
}

bool must_fail(const void *return_address)
{
    if (!watch.recording)
        return false;
    const std::uintptr_t site = our_site(return_address);
    if (!site)
        return false;
    record(site);
    if (watch.countdown < 0 || watch.countdown-- > 0)
        return false;
    watch.failed_site = site;
    return true;
}

struct EndDwfl {
    void operator()(Dwfl *dwfl) const { dwfl_end(dwfl); }
};
using DwflPointer = std::unique_ptr<Dwfl, EndDwfl>;

DwflPointer open_process()
{
    static const Dwfl_Callbacks callbacks = {
        .find_elf = dwfl_linux_proc_find_elf,
        .find_debuginfo = dwfl_standard_find_debuginfo,
        .section_address = nullptr,
        .debuginfo_path = nullptr,
    };
    DwflPointer dwfl(dwfl_begin(&callbacks));
    if (dwfl && (dwfl_linux_proc_report(dwfl.get(), getpid()) != 0 ||
                 dwfl_report_end(dwfl.get(), nullptr, nullptr) != 0))
        dwfl.reset();
    return dwfl;
}

template <std::size_t Capacity>
bool add(std::array<Range, Capacity> &ranges, std::size_t &count, Range range)
{
    if (count == Capacity)
        return false;
    ranges[count++] = range;
    return true;
}

bool is_one_of(std::string_view path, std::span<const std::string> files)
{
    return std::any_of(files.begin(), files.end(),
                       [path](const std::string &file) { return path.ends_with(file); });
}

/// The code of the compilation units of these files
bool find_units(Dwfl_Module *module, std::span<const std::string> files)
{
    Dwarf_Addr bias = 0;
    Dwarf_Die *unit = nullptr;
    while ((unit = dwfl_module_nextcu(module, unit, &bias))) {
        const char *name = dwarf_diename(unit);
        if (!name || !is_one_of(name, files))
            continue;
        Dwarf_Addr base = 0;
        Dwarf_Addr begin = 0;
        Dwarf_Addr end = 0;
        ptrdiff_t offset = 0;
        while ((offset = dwarf_ranges(unit, offset, &base, &begin, &end)) > 0)
            if (!add(watch.ours, watch.num_ours, {begin + bias, end + bias}))
                return false;
    }
    return true;
}

bool find_helpers(Dwfl_Module *module, std::span<const std::string> helpers)
{
    const int symbols = dwfl_module_getsymtab(module);
    for (int i = 0; i < symbols; ++i) {
        GElf_Sym symbol;
        GElf_Addr address = 0;
        const char *name =
            dwfl_module_getsym_info(module, i, &symbol, &address, nullptr, nullptr, nullptr);
        if (name && std::find(helpers.begin(), helpers.end(), name) != helpers.end() &&
            !add(watch.helpers, watch.num_helpers, {address, address + symbol.st_size}))
            return false;
    }
    return true;
}

struct Search {
    std::string library;
    Dwfl_Module *module = nullptr;
};

int compare_module(Dwfl_Module *module, void ** /*user_data*/, const char *name,
                   Dwarf_Addr /*begin*/, void *argument)
{
    auto *search = static_cast<Search *>(argument);
    if (std::string_view(name).find("/" + search->library) == std::string_view::npos)
        return DWARF_CB_OK;
    search->module = module;
    return DWARF_CB_ABORT;
}

} // namespace

Status watch_allocations(const std::string &library, std::span<const std::string> files,
                         std::span<const std::string> helpers)
{
    const DwflPointer dwfl = open_process();
    if (!dwfl)
        return Error{fmt::format("the process cannot be examined: {}", dwfl_errmsg(-1))};
    Search search{library};
    dwfl_getmodules(dwfl.get(), compare_module, &search, 0);
    if (!search.module)
        return Error{fmt::format("{} is not loaded", library)};
    if (!find_units(search.module, files) || !find_helpers(search.module, helpers))
        return Error{"there is more code to watch than there is room for"};
    if (watch.num_ours == 0)
        return Error{fmt::format("{} has no debugging information of these files", library)};
    return ok;
}

void fail_allocation(int n)
{
    watch.failed_site = 0;
    watch.countdown = n;
    watch.recording = true;
}

Allocations stop_failing()
{
    watch.recording = false;
    watch.countdown = -1;
    Allocations result{.failed = watch.failed_site != 0, .site = watch.failed_site};
    for (const auto &place : watch.places)
        if (place)
            result.places.push_back(place);
    return result;
}

std::string describe_site(std::uintptr_t site)
{
    const DwflPointer dwfl = open_process();
    Dwfl_Module *module = dwfl ? dwfl_addrmodule(dwfl.get(), site) : nullptr;
    if (!module)
        return fmt::format("{:#x}", site);
    const char *function = dwfl_module_addrname(module, site);
    std::string text = function ? function : "?";
    // Clang writes no table that leads from addresses to units.
    Dwarf_Addr bias = 0;
    Dwarf_Die *unit = nullptr;
    while ((unit = dwfl_module_nextcu(module, unit, &bias))) {
        if (dwarf_haspc(unit, site - bias) <= 0)
            continue;
        Dwarf_Line *line = dwarf_getsrc_die(unit, site - bias);
        const char *file = line ? dwarf_linesrc(line, nullptr, nullptr) : nullptr;
        int number = 0;
        if (file && dwarf_lineno(line, &number) == 0)
            text +=
                fmt::format(" ({}:{})", std::filesystem::path(file).filename().string(), number);
        break;
    }
    return text;
}

} // namespace kb::test

#define KB_MUST_FAIL kb::test::must_fail(__builtin_return_address(0))

extern "C" {

void *malloc(std::size_t size) noexcept
{
    if (KB_MUST_FAIL)
        return nullptr;
    return __interceptor_malloc ? __interceptor_malloc(size) : __libc_malloc(size);
}

void *calloc(std::size_t count, std::size_t size) noexcept
{
    if (KB_MUST_FAIL)
        return nullptr;
    return __interceptor_calloc ? __interceptor_calloc(count, size) : __libc_calloc(count, size);
}

void *realloc(void *old, std::size_t size) noexcept
{
    if (KB_MUST_FAIL)
        return nullptr;
    return __interceptor_realloc ? __interceptor_realloc(old, size) : __libc_realloc(old, size);
}

void *aligned_alloc(std::size_t alignment, std::size_t size) noexcept
{
    if (KB_MUST_FAIL)
        return nullptr;
    return __interceptor_memalign ? __interceptor_memalign(alignment, size)
                                  : __libc_memalign(alignment, size);
}

int posix_memalign(void **result, std::size_t alignment, std::size_t size) noexcept
{
    if (KB_MUST_FAIL)
        return ENOMEM;
    void *memory = __interceptor_memalign ? __interceptor_memalign(alignment, size)
                                          : __libc_memalign(alignment, size);
    if (!memory)
        return ENOMEM;
    *result = memory;
    return 0;
}
}
