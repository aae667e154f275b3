#include "render/parts/counts_file.h"

#include "base/error.h"
#include "base/io/file.h"
#include "trace/view.h"

namespace tyndall {
namespace {
constexpr std::string_view magic = "tyndall counts 1\n";
constexpr size_t header_size = magic.size() + 16;
constexpr int max_side = 4096; // tiles

void append(std::string& bytes, uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 255);
}

uint32_t number_at(const std::string& bytes, size_t at, int count) {
    uint32_t value = 0;
    for (int i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<size_t>(i)]);
    return value;
}
}

std::string save_counts(const std::filesystem::path& file, const TileFactors& counts) {
    std::string bytes(magic);
    for (const int value : {counts.low.x, counts.low.y, counts.factors.size.x, counts.factors.size.y})
        append(bytes, static_cast<uint32_t>(value), 4);
    for (const uint16_t factor : counts.factors.pixels) append(bytes, factor, 2);
    write_file_atomically(file, bytes);
    return content_hash(bytes);
}

std::shared_ptr<const TileFactors> load_counts(const std::filesystem::path& file, const std::string& hash) {
    const std::string bytes = read_file(file);
    if (!bytes.starts_with(magic) || bytes.size() < header_size)
        refuse(file.string(), "does not contain sample counts");
    if (content_hash(bytes) != hash) refuse(file.string(), "damaged, or made for another plan");
    int numbers[4];
    for (size_t i = 0; i < 4; ++i) numbers[i] = static_cast<int>(number_at(bytes, magic.size() + 4 * i, 4));
    const auto [x, y, columns, rows] = numbers;
    const bool small = x >= 0 && y >= 0 && columns > 0 && rows > 0 && columns <= max_side && rows <= max_side;
    if (!small || bytes.size() != header_size + 2 * static_cast<size_t>(columns) * static_cast<size_t>(rows))
        refuse(file.string(), "damaged: its size does not match its header");
    auto counts = std::make_shared<TileFactors>();
    counts->low = {x, y}, counts->factors = Image<uint16_t>(ivec2(columns, rows));
    for (size_t i = 0; i < counts->factors.pixels.size(); ++i)
        counts->factors.pixels[i] = static_cast<uint16_t>(number_at(bytes, header_size + 2 * i, 2));
    return counts;
}
}
