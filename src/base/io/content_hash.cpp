#include "base/io/file.h"
#include "base/text.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tyndall {
namespace {
constexpr uint64_t multiplier_1 = 0x87c37b91114253d5u, multiplier_2 = 0x4cf5ad432745937fu;

// Up to eight bytes, least significant first.
uint64_t little_endian(std::string_view bytes) {
    uint64_t value = 0;
    if (bytes.size() == 8 && std::endian::native == std::endian::little) {
        std::memcpy(&value, bytes.data(), 8);
        return value;
    }
    for (size_t i = bytes.size(); i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

uint64_t scrambled_1(uint64_t k) { return std::rotl(k * multiplier_1, 31) * multiplier_2; }
uint64_t scrambled_2(uint64_t k) { return std::rotl(k * multiplier_2, 33) * multiplier_1; }

uint64_t avalanched(uint64_t k) {
    k = (k ^ k >> 33) * 0xff51afd7ed558ccdu;
    k = (k ^ k >> 33) * 0xc4ceb9fe1a85ec53u;
    return k ^ k >> 33;
}

// MurmurHash3, x64 128-bit variant, seed 0 (Appleby, public domain algorithm).
struct Murmur {
    uint64_t a = 0, b = 0, length = 0;
    std::string rest; // under 16 bytes

    // Consumes whole 16-byte blocks and leaves the remainder in `bytes`.
    void add_blocks(std::string_view& bytes) {
        for (; bytes.size() >= 16; bytes.remove_prefix(16)) {
            a = std::rotl(a ^ scrambled_1(little_endian(bytes.substr(0, 8))), 27) + b;
            a = a * 5 + 0x52dce729u;
            b = std::rotl(b ^ scrambled_2(little_endian(bytes.substr(8, 8))), 31) + a;
            b = b * 5 + 0x38495ab5u;
        }
    }
    void add(std::string_view bytes) {
        length += bytes.size();
        if (!rest.empty()) { // complete the pending block first
            const size_t missing = std::min(16 - rest.size(), bytes.size());
            rest += bytes.substr(0, missing);
            bytes.remove_prefix(missing);
            if (rest.size() < 16) return;
            std::string_view block = rest;
            add_blocks(block);
        }
        add_blocks(bytes);
        rest = bytes;
    }
    std::string finish() {
        const std::string_view bytes = rest;
        if (bytes.size() > 8) b ^= scrambled_2(little_endian(bytes.substr(8)));
        a ^= scrambled_1(little_endian(bytes.substr(0, 8)));

        a ^= length, b ^= length;
        a += b, b += a;
        a = avalanched(a), b = avalanched(b);
        a += b, b += a;
        return hex_digits(a) + hex_digits(b);
    }
};
}

std::string content_hash(std::span<const std::string_view> pieces) {
    Murmur hash;
    for (const std::string_view piece : pieces) hash.add(piece);
    return hash.finish();
}

std::string content_hash(std::string_view bytes) { return content_hash(std::span(&bytes, 1)); }
}
