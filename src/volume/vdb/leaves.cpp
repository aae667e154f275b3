#include "volume/vdb/leaves.h"

#include "base/parallel.h"
#include "volume/bricks/half.h"
#include "volume/vdb/stream.h"

#include <openvdb/Types.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>
#include <openvdb/util/NodeMasks.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <stdexcept>

namespace tyndall {
namespace {
constexpr size_t leaves_at_once = 256; // a chunk of work; the pieces of a file do not show it
constexpr float largest_float = std::numeric_limits<float>::max();

// Mask, kind of inactive values, length of the chunk, values, and what blosc may add to those it cannot pack.
constexpr size_t max_bytes(bool half) { return sizeof(VoxelMask) + 1 + 8 + 512 * (half ? 2 : 4) + 16; }

// The values of the voxels in a mask, closed up. Returns their number.
size_t pack(const Leaf& leaf, const VoxelMask& mask, float* to) {
    const float* const begin = to;
    for (size_t w = 0; w < 8; ++w) {
        const float* from = leaf.values.data() + 64 * w;
        if (mask[w] == ~uint64_t{0})
            to = std::copy_n(from, 64, to);
        else
            for (uint64_t bits = mask[w]; bits != 0; bits &= bits - 1) *to++ = from[std::countr_zero(bits)];
    }
    return static_cast<size_t>(to - begin);
}

void encode(const Leaf& leaf, bool half, uint32_t compression, VoxelMask& mask, std::ostream& stream) {
    mask = voxels_above(leaf.values, half ? smallest_half / 2 : 0); // half of the smallest is rounded to 0
    std::array<float, 512> values;
    const size_t count = pack(leaf, mask, values.data());
    if (count == 0) return;
    stream.write(reinterpret_cast<const char*>(mask.data()), sizeof mask);
    stream.put(openvdb::io::NO_MASK_OR_INACTIVE_VALS);
    const auto size = static_cast<openvdb::Index>(count);
    if (half) {
        std::array<uint16_t, 512> halves;
        halves_from_floats(values.data(), count, halves.data());
        openvdb::io::writeData(stream, halves.data(), size, compression);
    } else {
        for (size_t v = 0; v < count; ++v) values[v] = std::min(values[v], largest_float);
        openvdb::io::writeData(stream, values.data(), size, compression);
    }
}

template<class T> constexpr bool is_three = !std::is_floating_point_v<T>;

template<class T> float component_of(const T& value, int component) {
    if constexpr (is_three<T>)
        return static_cast<float>(value[component]);
    else
        return static_cast<float>(value);
}

template<class T> T background_of(const LeafCoding& coding) {
    using Number = typename openvdb::VecTraits<T>::ElementType;
    if constexpr (is_three<T>)
        return T(static_cast<Number>(coding.background.x), static_cast<Number>(coding.background.y),
                 static_cast<Number>(coding.background.z));
    else
        return static_cast<T>(coding.background.x);
}

template<class T> void decode(std::istream& stream, const LeafCoding& coding, Leaf& leaf, VoxelMask& active) {
    openvdb::util::NodeMask<3> mask;
    mask.load(stream);
    for (openvdb::Index w = 0; w < 8; ++w) active[w] = mask.getWord<openvdb::Index64>(w);
    std::array<T, 512> values;
    openvdb::io::readCompressedValues(stream, values.data(), 512, mask, coding.half);
    std::ranges::transform(values, leaf.values.begin(),
                           [&](const T& value) { return component_of(value, coding.component); });
}

template<class T>
void decode_range(std::string_view bytes, std::span<const uint64_t> begins, size_t first, size_t last,
                  const LeafCoding& coding, std::span<Leaf> leaves, std::span<VoxelMask> active) {
    ByteSource source(bytes.substr(begins[first]));
    std::istream stream(&source);
    stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    const T background = background_of<T>(coding);
    openvdb::io::setVersion(stream, openvdb::VersionId(0, 0), coding.file_version);
    openvdb::io::setDataCompression(stream, coding.compression);
    openvdb::io::setGridBackgroundValuePtr(stream, &background);
    for (size_t n = first; n < last; ++n) {
        if (begins[first] + source.taken() != begins[n]) throw std::runtime_error("a leaf ends elsewhere");
        decode<T>(stream, coding, leaves[n], active[n]);
    }
    const uint64_t end = last < begins.size() ? begins[last] : bytes.size();
    if (begins[first] + source.taken() != end) throw std::runtime_error("a leaf ends elsewhere");
}
}

float stored_value(float value, bool half) {
    if (!(value > 0)) return 0;
    return half ? float_from_half(half_from_float(value)) : std::min(value, largest_float);
}

EncodedLeaves encode_leaves(size_t count, const LeafFill& fill, bool half, uint32_t compression) {
    EncodedLeaves result;
    result.masks.resize(count);
    result.pieces.resize((count + leaves_at_once - 1) / leaves_at_once);

    // Every piece has a place as large as it can become: nothing is moved later, and untouched pages cost nothing.
    const size_t room = max_bytes(half);
    result.memory = std::make_unique_for_overwrite<char[]>(count * room);
    parallel_for(static_cast<int64_t>(result.pieces.size()), [&](int64_t i) {
        const size_t first = static_cast<size_t>(i) * leaves_at_once, last = std::min(first + leaves_at_once, count);
        char* const to = result.memory.get() + first * room;
        ByteSink sink(to, (last - first) * room);
        std::ostream stream(&sink);
        stream.exceptions(std::ios::failbit | std::ios::badbit);
        Leaf leaf;
        for (size_t n = first; n < last; ++n) {
            fill(n, leaf);
            encode(leaf, half, compression, result.masks[n], stream);
        }
        result.pieces[static_cast<size_t>(i)] = {to, sink.size()};
    });
    return result;
}

void decode_leaves(std::string_view bytes, std::span<const uint64_t> begins, const LeafCoding& coding,
                   std::span<Leaf> leaves, std::span<VoxelMask> active) {
    assert(leaves.size() == begins.size() && active.size() == begins.size());
    parallel_ranges(static_cast<int64_t>(begins.size()), 64, [&](int64_t begin, int64_t end) {
        const auto decode = [&](auto range) {
            range(bytes, begins, static_cast<size_t>(begin), static_cast<size_t>(end), coding, leaves, active);
        };
        switch (coding.value) {
        case LeafValue::single:
            return decode(decode_range<float>);
        case LeafValue::wide:
            return decode(decode_range<double>);
        case LeafValue::three_single:
            return decode(decode_range<openvdb::Vec3s>);
        case LeafValue::three_wide:
            return decode(decode_range<openvdb::Vec3d>);
        }
    });
}
}
