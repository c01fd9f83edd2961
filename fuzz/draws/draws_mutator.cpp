// SPDX-License-Identifier: MIT
//
// Mutations of draw sequences by whole records, and of the arguments in one.

#include "fuzz/draws/machine.hpp"
#include "fuzz/random.hpp"

#include <algorithm>
#include <cstring>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t *data, std::size_t size, std::size_t max_size);

namespace kb::fuzz
{

namespace
{

using Record = std::array<std::uint8_t, record_size>;

std::uint8_t random_command(Random &random)
{
    static const std::vector<std::uint8_t> weighted = [] {
        std::vector<std::uint8_t> all;
        for (std::size_t i = 0; i < all_commands().size(); ++i)
            all.insert(all.end(), std::size_t(all_commands()[i].weight), std::uint8_t(i));
        return all;
    }();
    return random.pick(weighted);
}

Record random_record(Random &random)
{
    Record record{};
    record[0] = random_command(random);
    for (std::size_t i = 1; i < record.size(); ++i)
        record[i] = std::uint8_t(random.below(256));
    return record;
}

void mutate(Random &random, std::vector<Record> &records)
{
    using Difference = std::vector<Record>::difference_type;
    const auto place = [&] { return records.begin() + Difference(random.below(records.size())); };

    if (records.empty()) {
        records.push_back(random_record(random));
        return;
    }
    switch (random.below(8)) {
    case 0:
        records.erase(place());
        break;
    case 1: {
        const Record copy = *place();
        records.insert(place(), copy);
        break;
    }
    case 2:
        std::iter_swap(place(), place());
        break;
    case 3:
    case 4:
        (*place())[1 + random.below(record_size - 1)] = std::uint8_t(random.below(256));
        break;
    case 5:
        LLVMFuzzerMutate(place()->data(), record_size, record_size);
        break;
    default:
        records.insert(records.begin() + Difference(random.below(records.size() + 1)),
                       random_record(random));
    }
}

} // namespace

} // namespace kb::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size,
                                               std::size_t max_size, unsigned seed)
{
    using kb::fuzz::record_size;

    kb::fuzz::Random random(seed);
    std::vector<kb::fuzz::Record> records(size / record_size);
    for (std::size_t i = 0; i < records.size(); ++i)
        std::memcpy(records[i].data(), data + i * record_size, record_size);
    for (std::size_t i = 1 + random.below(5); i > 0; --i)
        kb::fuzz::mutate(random, records);
    records.resize(std::min(records.size(), max_size / record_size));
    for (std::size_t i = 0; i < records.size(); ++i)
        std::memcpy(data + i * record_size, records[i].data(), record_size);
    return records.size() * record_size;
}
