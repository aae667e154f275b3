#include "base/io/file_sequence.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace tyndall {
namespace fs = std::filesystem;

namespace {
// The text before and after the frame number in a pattern's file names.
struct NameParts {
    std::string before, after;
};

// The names of frames 1 and -1 first differ where the number begins, those of 1 and 2 at its last digit.
NameParts split_name(const std::string& pattern) {
    const std::string one = frame_name(pattern, 1), minus_one = frame_name(pattern, -1), two = frame_name(pattern, 2);
    const auto begin = std::ranges::mismatch(one, minus_one).in1, last = std::ranges::mismatch(one, two).in1;
    return {std::string(one.begin(), begin), std::string(last + 1, one.end())};
}

// Parses the frame number of a file name; false unless the pattern gives that frame exactly this name.
bool parse_name(const std::string& name, const std::string& pattern, const NameParts& parts, int& frame) {
    if (name.size() <= parts.before.size() + parts.after.size() || !name.starts_with(parts.before) ||
        !name.ends_with(parts.after))
        return false;
    const char *begin = name.data() + parts.before.size(), *end = name.data() + name.size() - parts.after.size();
    const auto [stop, error] = std::from_chars(begin, end, frame);
    return error == std::errc() && stop == end && frame_name(pattern, frame) == name;
}

bool is_numbered(const std::string& name) {
    try {
        return has_frame_token(name);
    } catch (const Error& error) {
        fail(ExitCode::refused, {}, error.what()); // the name comes from a scene, not from the command line
    }
}

// Remainder that is never negative.
int64_t modulo(int64_t value, int64_t period) { return (value % period + period) % period; }

// The frame of the sequence shown at `frame`; nothing outside the range of a clip.
std::optional<int64_t> mapped_frame(int64_t frame, int64_t first, int64_t last, SequenceMode mode) {
    if (frame >= first && frame <= last) return frame;
    const int64_t length = last - first + 1;
    switch (mode) {
    case SequenceMode::hold:
        return std::clamp(frame, first, last);
    case SequenceMode::loop:
        return first + modulo(frame - first, length);
    case SequenceMode::clip:
        return {};
    case SequenceMode::ping_pong: {
        if (length == 1) return first;
        const int64_t step = modulo(frame - first, 2 * (length - 1));
        return first + std::min(step, 2 * (length - 1) - step);
    }
    }
    return {};
}
}

FileSequence find_sequence(const std::string& pattern, const fs::path& base_directory) {
    const fs::path path = base_directory / pattern;
    const std::string name = path.filename().string();
    FileSequence sequence;
    sequence.pattern = path.string();
    std::error_code missing;
    // Only the file name may hold a frame token, and an existing file is taken literally even if its name holds one.
    if (fs::is_regular_file(path, missing) || !is_numbered(name)) {
        check_readable(path);
        return sequence;
    }

    const NameParts parts = split_name(name);
    std::error_code error;
    fs::directory_iterator entries(path.has_parent_path() ? path.parent_path() : fs::path("."), error);
    if (error) fail(ExitCode::unreadable, path.parent_path().string(), error.message());
    for (; entries != fs::directory_iterator(); entries.increment(error)) {
        int frame = 0;
        if (parse_name(entries->path().filename().string(), name, parts, frame)) sequence.files.push_back(frame);
    }
    if (error) fail(ExitCode::unreadable, path.parent_path().string(), error.message());
    if (sequence.files.empty()) fail(ExitCode::unreadable, sequence.pattern, "no file matches this sequence");
    std::ranges::sort(sequence.files);
    return sequence;
}

namespace {
// The files around a frame: its own, or the nearest earlier and later ones. The first and the last of a sequence exist.
struct Neighbors {
    int64_t wanted = 0;
    int before = 0, after = 0;
};

std::optional<Neighbors> neighbors_of(const FileSequence& sequence, int frame) {
    if (sequence.files.empty()) return {};
    const int64_t wanted = int64_t{frame} + sequence.offset;
    const auto mapped = mapped_frame(wanted, sequence.files.front(), sequence.files.back(), sequence.mode);
    if (!mapped) return {};
    const auto after = std::ranges::upper_bound(sequence.files, *mapped), before = after - 1;
    return Neighbors{*mapped, *before, *before == *mapped ? *before : *after};
}

fs::path file_of(const FileSequence& sequence, int64_t frame) {
    const fs::path path(sequence.pattern);
    return path.parent_path() / frame_name(path.filename().string(), static_cast<int>(frame));
}
}

std::optional<fs::path> sequence_file(const FileSequence& sequence, int frame, MissingFrame missing) {
    if (sequence.files.empty()) return fs::path(sequence.pattern);
    const auto near = neighbors_of(sequence, frame);
    if (!near) return {};
    if (near->before == near->wanted || missing == MissingFrame::hold) return file_of(sequence, near->before);
    if (missing == MissingFrame::skip) return {};
    fail(ExitCode::unreadable, file_of(sequence, near->wanted).string(),
         "is missing from a sequence of frames " + std::to_string(sequence.files.front()) + " to " +
             std::to_string(sequence.files.back()) + "; --missing hold or skip continues without it");
}

std::string gap_note(const FileSequence& sequence, int frame, MissingFrame missing) {
    const auto near = neighbors_of(sequence, frame);
    if (!near || near->before == near->wanted) return {};
    const auto name = [&](int64_t number) { return file_of(sequence, number).filename().string(); };
    const int64_t first = int64_t{near->before} + 1, last = int64_t{near->after} - 1;
    return name(first) + (first == last ? " is" : " to " + name(last) + " are") + " missing: " +
           (missing == MissingFrame::hold ? name(near->before) + " is shown instead" : "nothing is shown");
}

std::vector<std::filesystem::path> all_files(const FileSequence& sequence) {
    std::vector<std::filesystem::path> files;
    for (const int number : sequence.files) files.push_back(file_of(sequence, number));
    return files;
}
}
