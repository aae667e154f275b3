#include "base/io/frames.h"

#include "base/error.h"

#include <charconv>
#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_set>
#include <utility>

namespace tyndall {
namespace {
constexpr int64_t max_frames = 1000000;

// Parses a frame range from left to right; every error names its column.
class Reader {
public:
    explicit Reader(std::string_view text) : text_(text) {}

    bool at_end() const { return at_ == text_.size(); }
    bool take(char c) {
        if (at_end() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    // INT := '-'? digit+
    int integer(const char* what) {
        const size_t start = at_;
        size_t end = at_ + (at_ < text_.size() && text_[at_] == '-');
        const size_t digits = end;
        while (end < text_.size() && text_[end] >= '0' && text_[end] <= '9') ++end;
        if (end == digits) complain(digits, std::string("expected ") + what);
        int value = 0;
        const auto result = std::from_chars(text_.data() + start, text_.data() + end, value);
        if (result.ec != std::errc()) complain(start, std::string(what) + " is too large");
        at_ = end;
        return value;
    }

    [[noreturn]] void complain(size_t column, const std::string& what) const {
        fail(ExitCode::usage, "frames " + printable(text_, 80), "column " + std::to_string(column + 1) + ": " + what);
    }
    size_t column() const { return at_; }
    std::string_view rest() const { return text_.substr(at_); }

private:
    std::string_view text_;
    size_t at_ = 0;
};

struct Range {
    int64_t first, last, step;
    int64_t count() const { return (last - first) / step + 1; }
};

// item := INT | INT '-' INT | INT '-' INT ('x' | ':') INT
Range parse_item(Reader& reader) {
    const size_t start = reader.column();
    const int64_t first = reader.integer("a frame number");
    if (!reader.take('-')) return {first, first, 1};
    const int64_t last = reader.integer("a frame number");
    const size_t step_column = reader.column();
    if (!reader.take('x') && !reader.take(':')) {
        if (last < first)
            reader.complain(start, "the range runs backwards; count down with " + std::to_string(first) + "-" +
                                       std::to_string(last) + "x-1");
        return {first, last, 1};
    }
    const int64_t step = reader.integer("a step");
    if (step == 0) reader.complain(step_column + 1, "the step must not be 0");
    if (last != first && (last > first) != (step > 0))
        reader.complain(step_column + 1, "the step leads away from the last frame");
    return {first, last, step};
}
}

std::vector<int> parse_frames(std::string_view text) {
    Reader reader(text);
    std::vector<int> frames;
    std::unordered_set<int> seen;
    int64_t total = 0;
    do {
        const size_t start = reader.column();
        const Range range = parse_item(reader);
        total += range.count();
        if (total > max_frames) reader.complain(start, "more than " + std::to_string(max_frames) + " frames");
        for (int64_t i = 0; i < range.count(); ++i) {
            const int frame = static_cast<int>(range.first + i * range.step);
            if (seen.insert(frame).second) frames.push_back(frame);
        }
    } while (reader.take(','));
    if (reader.at_end()) return frames;
    if (reader.take(':')) reader.complain(reader.column() - 1, "expected FIRST-LAST before the step, as in 1-10x2");
    reader.complain(reader.column(), "unexpected '" + printable(reader.rest().substr(0, 1)) + "'; expected - x or ,");
}

namespace {
// "7", "1-9" or "1-9x2"
std::string piece_text(const std::vector<int>& frames, size_t start, size_t end) {
    std::string text = std::to_string(frames[start]);
    if (end == start) return text;
    const int64_t step = int64_t{frames[start + 1]} - frames[start];
    text.append("-").append(std::to_string(frames[end]));
    return step == 1 ? text : text.append("x").append(std::to_string(step));
}

// The last piece of the shortest text for all frames up to a given one.
struct Piece {
    int64_t cost = 0; // number of characters, ties broken by fewer pieces
    size_t start = 0;
};

constexpr int64_t per_character = int64_t{1} << 24;

int64_t piece_cost(const std::vector<int>& frames, size_t start, size_t end) {
    return static_cast<int64_t>(piece_text(frames, start, end).size() + 1) * per_character + 1;
}
}

std::vector<int> frames_between(int first, int last) {
    std::vector<int> frames;
    for (int frame = first; frame <= last; ++frame) frames.push_back(frame);
    return frames;
}

std::vector<int> spread_frames(const std::vector<int>& frames) {
    if (frames.size() < 3) return frames;
    std::vector<int> result{frames.front(), frames.back()};
    std::deque<std::pair<size_t, size_t>> gaps{{0, frames.size() - 1}};
    for (; !gaps.empty(); gaps.pop_front()) {
        const auto [low, high] = gaps.front();
        if (high - low < 2) continue;
        const size_t middle = (low + high) / 2;
        result.push_back(frames[middle]);
        gaps.insert(gaps.end(), {{low, middle}, {middle, high}});
    }
    return result;
}

std::string format_frames(const std::vector<int>& frames) {
    // Dynamic programming over prefixes: a piece is one frame or an evenly spaced run, from its first or second frame
    // on.
    std::vector<Piece> best(frames.size());
    size_t run = 0;
    for (size_t i = 0; i < frames.size(); ++i) {
        if (i >= 2 && int64_t{frames[i]} - frames[i - 1] != int64_t{frames[i - 1]} - frames[i - 2]) run = i - 1;
        best[i].cost = INT64_MAX;
        for (const size_t start : {i, i - 1, run + 1, run}) {
            if (start > i || (start < i && frames[start] == frames[start + 1])) continue;
            const int64_t cost = (start ? best[start - 1].cost : 0) + piece_cost(frames, start, i);
            if (cost < best[i].cost) best[i] = {cost, start};
        }
    }

    std::vector<std::string> pieces; // last first
    for (size_t end = frames.size(); end-- > 0; end = best[end].start)
        pieces.push_back(piece_text(frames, best[end].start, end));
    std::string text;
    for (size_t i = pieces.size(); i-- > 0;) text.append(pieces[i]).append(i > 0 ? "," : "");
    return text;
}
}
