#include "base/io/file_sequence.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Frames of the files shown at scene frames first..last; -1000 for no fog.
std::vector<int> shown(const FileSequence& sequence, int first, int last, MissingFrame missing = MissingFrame::error) {
    std::vector<int> result;
    for (int frame = first; frame <= last; ++frame) {
        const auto file = sequence_file(sequence, frame, missing);
        result.push_back(file ? std::stoi(file->stem().string().substr(2)) : -1000);
    }
    return result;
}

class Sequence : public ::testing::Test {
protected:
    const TempFolder scratch;

    FileSequence made(const std::vector<std::string>& names, const std::string& pattern) {
        for (const std::string& name : names) scratch.put(name, "x");
        return find_sequence(pattern, scratch.path());
    }
};

TEST_F(Sequence, OneFile) {
    const FileSequence sequence = made({"fog.vdb"}, "fog.vdb");
    EXPECT_TRUE(sequence.files.empty());
    for (const int frame : {-5, 1, 1000})
        EXPECT_EQ(sequence_file(sequence, frame, MissingFrame::error), scratch.path() / "fog.vdb");
    EXPECT_EQ(error_of([&] { find_sequence("other.vdb", scratch.path()); }).code, ExitCode::unreadable);
    EXPECT_EQ(error_of([&] { find_sequence("", scratch.path()); }).code, ExitCode::unreadable);
}

TEST_F(Sequence, EverySpellingOfTheNumber) {
    const std::vector<std::string> names = {"a.0001.vdb",           "a.0003.vdb",    "a.0010.vdb", "a.10000.vdb",
                                            "a.-0002.vdb",          "a.001.vdb",     "a.1.vdb",    "a.0004.exr",
                                            "b.0005.vdb",           "a.x.vdb",       "a..vdb",     "a.00x1.vdb",
                                            "a.99999999999999.vdb", "a.0006.vdb.tmp"};
    for (const char* pattern : {"a.####.vdb", "a.%04d.vdb", "a.$F4.vdb"})
        EXPECT_THAT(made(names, pattern).files, ElementsAre(-2, 1, 3, 10, 10000)) << pattern;
    EXPECT_THAT(made(names, "a.$F.vdb").files, ElementsAre(1, 10000));
    EXPECT_THAT(made({"v00012.vdb", "v00013.vdb", "v1.vdb"}, "v0####.vdb").files, ElementsAre(12, 13));
}

TEST_F(Sequence, AFileThatIsThereMayBeCalledAnything) {
    for (const char* name : {"take#2.vdb", "50%.vdb", "a%b.vdb", "a$F.vdb", "####.vdb"}) {
        const FileSequence sequence = made({name}, name);
        EXPECT_TRUE(sequence.files.empty()) << name;
        EXPECT_EQ(sequence_file(sequence, 3, MissingFrame::error), scratch.path() / name);
    }
    EXPECT_EQ(error_of([&] { find_sequence("c%b.vdb", scratch.path()); }).code, ExitCode::refused);
}

TEST_F(Sequence, InADirectoryBelow) {
    std::filesystem::create_directory(scratch.path() / "50%");
    scratch.put("50%/a.0007.vdb", "x");
    const FileSequence sequence = find_sequence("a.####.vdb", scratch.path() / "50%");
    EXPECT_EQ(sequence_file(sequence, 7, MissingFrame::error), scratch.path() / "50%" / "a.0007.vdb");
    EXPECT_EQ(find_sequence((scratch.path() / "50%" / "a.0007.vdb").string(), "/nowhere").files.size(), 0u);
}

TEST_F(Sequence, NothingThere) {
    const Error none = error_of([&] { made({"a.vdb"}, "a.####.vdb"); });
    EXPECT_EQ(none.code, ExitCode::unreadable);
    EXPECT_THAT(none.what(), HasSubstr("a.####.vdb"));
    EXPECT_EQ(error_of([&] { find_sequence("x/a.####.vdb", scratch.path()); }).code, ExitCode::unreadable);
    EXPECT_EQ(error_of([&] { find_sequence("####/a.vdb", scratch.path()); }).code, ExitCode::unreadable);
}

TEST_F(Sequence, OutsideTheRange) {
    FileSequence sequence = made({"a.0003.vdb", "a.0004.vdb", "a.0005.vdb"}, "a.####.vdb");
    EXPECT_THAT(shown(sequence, 1, 7), ElementsAre(3, 3, 3, 4, 5, 5, 5));
    sequence.mode = SequenceMode::clip;
    EXPECT_THAT(shown(sequence, 2, 6), ElementsAre(-1000, 3, 4, 5, -1000));
    sequence.mode = SequenceMode::loop;
    EXPECT_THAT(shown(sequence, -1, 9), ElementsAre(5, 3, 4, 5, 3, 4, 5, 3, 4, 5, 3));
    sequence.mode = SequenceMode::ping_pong;
    EXPECT_THAT(shown(sequence, -1, 11), ElementsAre(3, 4, 5, 4, 3, 4, 5, 4, 3, 4, 5, 4, 3));
}

TEST_F(Sequence, OffsetIsAddedToTheFrame) {
    FileSequence sequence = made({"a.0103.vdb", "a.0104.vdb"}, "a.####.vdb");
    sequence.offset = 100, sequence.mode = SequenceMode::clip;
    EXPECT_THAT(shown(sequence, 2, 5), ElementsAre(-1000, 103, 104, -1000));
    sequence.offset = INT32_MAX, sequence.mode = SequenceMode::loop;
    EXPECT_THAT(shown(sequence, INT32_MAX - 1, INT32_MAX - 1), ElementsAre(103)); // 2^32 - 3 - 103 is even
}

TEST_F(Sequence, OneFrameOnly) {
    FileSequence sequence = made({"a.0005.vdb"}, "a.####.vdb");
    for (const SequenceMode mode : {SequenceMode::hold, SequenceMode::loop, SequenceMode::ping_pong}) {
        sequence.mode = mode;
        EXPECT_THAT(shown(sequence, 4, 6), ElementsAre(5, 5, 5));
    }
}

TEST_F(Sequence, Gaps) {
    FileSequence sequence = made({"a.0001.vdb", "a.0002.vdb", "a.0005.vdb"}, "a.####.vdb");
    EXPECT_THAT(shown(sequence, 1, 5, MissingFrame::hold), ElementsAre(1, 2, 2, 2, 5));
    EXPECT_THAT(shown(sequence, 1, 5, MissingFrame::skip), ElementsAre(1, 2, -1000, -1000, 5));
    const Error error = error_of([&] { shown(sequence, 1, 5); });
    EXPECT_EQ(error.code, ExitCode::unreadable);
    EXPECT_THAT(error.what(), HasSubstr("a.0003.vdb"));
    for (const int frame : {3, 4}) {
        EXPECT_EQ(gap_note(sequence, frame, MissingFrame::hold),
                  "a.0003.vdb to a.0004.vdb are missing: a.0002.vdb is shown instead");
        EXPECT_EQ(gap_note(sequence, frame, MissingFrame::skip),
                  "a.0003.vdb to a.0004.vdb are missing: nothing is shown");
    }
    for (const int frame : {-1, 2, 5, 9}) EXPECT_EQ(gap_note(sequence, frame, MissingFrame::hold), "");
    sequence.files = {1, 2, 4};
    EXPECT_EQ(gap_note(sequence, 3, MissingFrame::skip), "a.0003.vdb is missing: nothing is shown");
    sequence.files = {1, 2, 5};
    sequence.mode = SequenceMode::loop;
    EXPECT_THAT(shown(sequence, 6, 10, MissingFrame::skip), ElementsAre(1, 2, -1000, -1000, 5));
}
}
}
