#include "volume/vdb/library/leaves.h"

#include "base/parallel.h"
#include "volume/bricks/half.h"
#include "volume/vdb/library/stream.h"

#include <openvdb/Types.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>
#include <openvdb/util/NodeMasks.h>

#include <algorithm>
#include <cassert>
#include <deque>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace tyndall {
namespace {
constexpr size_t leaves_at_once = 256; // work per task; does not affect the file
constexpr float largest_float = std::numeric_limits<float>::max();

size_t components(const VdbGridContent& grid) { return grid.vector ? 3 : 1; }

// Mask, inactive-value flag, chunk length, values, and the overhead of Blosc for incompressible data.
size_t max_bytes(const VdbGridContent& grid, bool half) {
    return sizeof(VoxelMask) + 1 + 8 + 512 * components(grid) * (half ? 2 : 4) + 16;
}

// Copies the values of the voxels in a mask contiguously. Returns their number.
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

// Voxels where any scalar grid is nonzero as stored.
VoxelMask active_voxels(std::span<const Leaf> leaves, std::span<const VdbGridContent> grids, bool half) {
    VoxelMask mask{};
    size_t at = 0;
    for (const VdbGridContent& grid : grids) {
        if (!grid.vector) {
            // Values up to half the smallest half float round to 0.
            const VoxelMask some = voxels_above(leaves[at].values, half ? smallest_half / 2 : 0);
            for (size_t w = 0; w < mask.size(); ++w) mask[w] |= some[w];
        }
        at += components(grid);
    }
    return mask;
}

void encode_numbers(const Leaf& leaf, const VoxelMask& mask, bool half, uint32_t compression, std::ostream& stream) {
    std::array<float, 512> values;
    const size_t count = pack(leaf, mask, values.data());
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

void encode_vectors(std::span<const Leaf, 3> leaves, const VoxelMask& mask, bool half, uint32_t compression,
                    std::ostream& stream) {
    std::array<std::array<float, 512>, 3> parts;
    size_t count = 0;
    for (size_t c = 0; c < 3; ++c) count = pack(leaves[c], mask, parts[c].data());
    const auto size = static_cast<openvdb::Index>(count);
    const auto write = [&]<class Vector>(float most, std::type_identity<Vector>) {
        using Number = typename Vector::ValueType;
        std::array<Vector, 512> vectors;
        for (size_t v = 0; v < count; ++v)
            for (size_t c = 0; c < 3; ++c)
                vectors[v][static_cast<int>(c)] = Number(std::clamp(parts[c][v], -most, most));
        openvdb::io::writeData(stream, vectors.data(), size, compression);
    };
    if (half)
        write(largest_half, std::type_identity<openvdb::Vec3H>());
    else
        write(largest_float, std::type_identity<openvdb::Vec3s>());
}

// Encodes a leaf of one grid; writes nothing if no voxel is active.
void encode(std::span<const Leaf> leaves, const VoxelMask& mask, bool half, uint32_t compression,
            std::ostream& stream) {
    if (count_voxels(mask) == 0) return;
    stream.write(reinterpret_cast<const char*>(mask.data()), sizeof mask);
    stream.put(openvdb::io::NO_MASK_OR_INACTIVE_VALS);
    if (leaves.size() == 1)
        encode_numbers(leaves[0], mask, half, compression, stream);
    else
        encode_vectors(leaves.first<3>(), mask, half, compression, stream);
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
        if (begins[first] + source.taken() != begins[n]) throw std::runtime_error("a leaf has the wrong length");
        decode<T>(stream, coding, leaves[n], active[n]);
    }
    const uint64_t end = last < begins.size() ? begins[last] : bytes.size();
    if (begins[first] + source.taken() != end) throw std::runtime_error("a leaf has the wrong length");
}
}

float stored_value(float value, bool half) {
    if (!(value > 0)) return 0;
    return half ? float_from_half(half_from_float(value)) : std::min(value, largest_float);
}

namespace {
// Output of one task for one grid, at an offset for maximum sizes: nothing is moved later, untouched pages are free.
struct Piece {
    ByteSink sink;
    std::ostream stream;

    Piece(char* room, size_t bytes) : sink(room, bytes), stream(&sink) {
        stream.exceptions(std::ios::failbit | std::ios::badbit);
    }
};
}

EncodedLeaves encode_leaves(size_t count, std::span<const VdbGridContent> grids, const LeafFill& fill, bool half,
                            uint32_t compression) {
    EncodedLeaves result;
    result.masks.resize(count);
    const size_t pieces = (count + leaves_at_once - 1) / leaves_at_once;
    size_t width = 0;
    for (const VdbGridContent& grid : grids) {
        EncodedValues& values = result.grids.emplace_back();
        values.pieces.resize(pieces);
        values.memory = std::make_unique_for_overwrite<char[]>(count * max_bytes(grid, half));
        width += components(grid);
    }
    parallel_for(static_cast<int64_t>(pieces), [&](int64_t i) {
        const size_t first = static_cast<size_t>(i) * leaves_at_once, last = std::min(first + leaves_at_once, count);
        std::deque<Piece> open;
        for (size_t g = 0; g < grids.size(); ++g) {
            const size_t room = max_bytes(grids[g], half);
            open.emplace_back(result.grids[g].memory.get() + first * room, (last - first) * room);
        }
        std::vector<Leaf> leaves(width);
        for (size_t n = first; n < last; ++n) {
            fill(n, leaves);
            const VoxelMask mask = result.masks[n] = active_voxels(leaves, grids, half);
            size_t at = 0;
            for (size_t g = 0; g < grids.size(); at += components(grids[g]), ++g)
                encode(std::span(leaves).subspan(at, components(grids[g])), mask, half, compression, open[g].stream);
        }
        for (size_t g = 0; g < grids.size(); ++g)
            result.grids[g].pieces[static_cast<size_t>(i)] = {
                result.grids[g].memory.get() + first * max_bytes(grids[g], half), open[g].sink.size()};
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
