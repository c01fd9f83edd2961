// SPDX-License-Identifier: MIT

#include "lib/io/gltf_accessor.hpp"

#include "lib/io/little_endian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace kb
{

namespace
{

/// So many elements may be all zeros, which no buffer has to back.
constexpr std::size_t max_zeros = 1U << 27U;

/// The bytes of a part of a buffer view: `count` elements of `bytes` each, `stride` apart.
Result<const unsigned char *> find_bytes(const tinygltf::Model &model, int view_index,
                                         std::size_t offset, std::size_t count, std::size_t bytes,
                                         std::size_t stride)
{
    if (view_index < 0 || static_cast<std::size_t>(view_index) >= model.bufferViews.size())
        return Error{fmt::format("there is no buffer view {}", view_index)};
    const tinygltf::BufferView &view = model.bufferViews[static_cast<std::size_t>(view_index)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
        return Error{fmt::format("there is no buffer {}", view.buffer)};
    const auto &data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        return Error{fmt::format("buffer view {} is longer than its buffer", view_index)};
    const bool fits = offset <= view.byteLength && bytes <= view.byteLength - offset &&
                      count - 1 <= (view.byteLength - offset - bytes) / stride;
    if (count > 0 && !fits)
        return Error{fmt::format("buffer view {} is too short for {} elements", view_index, count)};
    return data.data() + view.byteOffset + offset;
}

template <class T>
double number_at(const unsigned char *bytes, bool normalized)
{
    const T value = read_little_endian<T>(bytes);
    if (!normalized || !std::numeric_limits<T>::is_integer)
        return static_cast<double>(value);
    return std::max(static_cast<double>(value) / static_cast<double>(std::numeric_limits<T>::max()),
                    -1.0);
}

double number_at(const unsigned char *bytes, int type, bool normalized)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return number_at<std::int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return number_at<std::uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return number_at<std::int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return number_at<std::uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return number_at<std::uint32_t>(bytes, normalized);
    default:
        return number_at<float>(bytes, normalized);
    }
}

/// 0: none that glTF has.
std::size_t component_bytes(int type)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        return 0;
    }
}

std::size_t component_count(int type)
{
    switch (type) {
    case TINYGLTF_TYPE_SCALAR:
        return 1;
    case TINYGLTF_TYPE_VEC2:
        return 2;
    case TINYGLTF_TYPE_VEC3:
        return 3;
    case TINYGLTF_TYPE_VEC4:
        return 4;
    default:
        return 0;
    }
}

/// Puts the elements of a sparse accessor that differ into their places.
Status replace_sparse(const tinygltf::Model &model, const tinygltf::Accessor &accessor,
                      AccessorValues &all)
{
    const auto &sparse = accessor.sparse;
    const std::size_t index_bytes = component_bytes(sparse.indices.componentType);
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
        sparse.indices.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT || index_bytes == 0)
        return Error{"its sparse part is malformed"};
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t bytes = component_bytes(accessor.componentType);
    const std::size_t element = bytes * all.components;
    const auto indices = find_bytes(model, sparse.indices.bufferView,
                                    static_cast<std::size_t>(sparse.indices.byteOffset), count,
                                    index_bytes, index_bytes);
    if (!indices)
        return indices.error();
    const auto values =
        find_bytes(model, sparse.values.bufferView,
                   static_cast<std::size_t>(sparse.values.byteOffset), count, element, element);
    if (!values)
        return values.error();
    for (std::size_t i = 0; i < count; ++i) {
        const auto place = static_cast<std::size_t>(
            number_at(*indices + i * index_bytes, sparse.indices.componentType, false));
        if (place >= all.count)
            return Error{fmt::format("its sparse part has index {} of {}", place, all.count)};
        for (std::size_t c = 0; c < all.components; ++c)
            all.values[place * all.components + c] = number_at(
                *values + i * element + c * bytes, accessor.componentType, accessor.normalized);
    }
    return ok;
}

Result<AccessorValues> read(const tinygltf::Model &model, const tinygltf::Accessor &accessor)
{
    const std::size_t bytes = component_bytes(accessor.componentType);
    const std::size_t components = component_count(accessor.type);
    if (bytes == 0 || components == 0)
        return Error{"it has a type that is none of vertices"};
    AccessorValues all{accessor.count, components, {}};
    if (accessor.bufferView < 0) {
        if (accessor.count > max_zeros)
            return Error{fmt::format("its {} elements are too many", accessor.count)};
        all.values.resize(all.count * components);
    } else {
        const std::size_t element = bytes * components;
        const auto view = static_cast<std::size_t>(accessor.bufferView);
        const std::size_t given =
            view < model.bufferViews.size() ? model.bufferViews[view].byteStride : 0;
        const std::size_t stride = given > 0 ? given : element;
        if (stride < element)
            return Error{
                fmt::format("its elements of {} bytes are {} bytes apart in buffer view {}",
                            element, stride, view)};
        const auto data = find_bytes(model, accessor.bufferView, accessor.byteOffset,
                                     accessor.count, element, stride);
        if (!data)
            return data.error();
        all.values.reserve(all.count * components);
        for (std::size_t i = 0; i < all.count; ++i)
            for (std::size_t c = 0; c < components; ++c)
                all.values.push_back(number_at(*data + i * stride + c * bytes,
                                               accessor.componentType, accessor.normalized));
    }
    if (accessor.sparse.isSparse) {
        if (auto replaced = replace_sparse(model, accessor, all); !replaced)
            return replaced.error();
    }
    return all;
}

} // namespace

Result<AccessorValues> read_accessor(const tinygltf::Model &model, int index)
{
    if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size())
        return Error{fmt::format("there is no accessor {}", index)};
    auto values = read(model, model.accessors[static_cast<std::size_t>(index)]);
    if (!values)
        return Error{fmt::format("accessor {}: {}", index, values.error().message)};
    return values;
}

} // namespace kb
