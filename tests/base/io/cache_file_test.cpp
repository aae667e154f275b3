#include "base/io/cache_file.h"
#include "base/io/file.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>

namespace tyndall {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;

const std::string made_from(32, 'a');

// One field of every kind.
struct Everything {
    int number = 0;
    vec3 place{0};
    std::string text;
    std::vector<float> floats;
    SharedArray<uint16_t> halves;
    std::shared_ptr<const std::vector<float>> shared, none;
};

template<class Visit> void fields(Everything& thing, Visit& visit) {
    visit(thing.number), visit(thing.place), visit(thing.text), visit(thing.floats), visit(thing.halves);
    visit(thing.shared), visit(thing.none);
}

Everything something() {
    return {7,
            {1, -2, 3},
            "fog",
            {0.5f, infinity},
            std::vector<uint16_t>{1, 2, 65535},
            std::make_shared<const std::vector<float>>(5, 2.0f),
            nullptr};
}

void write(const std::filesystem::path& path, Everything thing) {
    CacheWriter writer;
    fields(thing, writer);
    write_cache_file(path, made_from, 1.5, writer.pieces());
    EXPECT_EQ(std::filesystem::file_size(path), cache_file_size(writer.pieces()));
}

Everything read(const std::filesystem::path& path) {
    const auto file = open_cache_file(path, made_from);
    Everything thing;
    CacheReader reader(file);
    fields(thing, reader);
    reader.finish();
    return thing;
}

TEST(CacheFile, GivesBackEveryField) {
    const TempFolder scratch;
    write(scratch / "a.cache", something());
    EXPECT_EQ(open_cache_file(scratch / "a.cache", made_from)->seconds, 1.5);
    const Everything thing = read(scratch / "a.cache"), wanted = something();
    EXPECT_EQ(thing.number, wanted.number);
    EXPECT_EQ(thing.place, wanted.place);
    EXPECT_EQ(thing.text, wanted.text);
    EXPECT_EQ(thing.floats, wanted.floats);
    EXPECT_EQ(thing.halves, wanted.halves);
    EXPECT_EQ(*thing.shared, *wanted.shared);
    EXPECT_EQ(thing.none, nullptr);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(thing.halves.data()) % cache_alignment, 0u);
    EXPECT_THAT(scratch.names(), ElementsAre("a.cache"));
}

TEST(CacheFile, TheSameThingHasTheSameBytes) {
    const TempFolder scratch;
    write(scratch / "a.cache", something());
    write(scratch / "b.cache", something());
    EXPECT_EQ(bytes_of(scratch / "a.cache"), bytes_of(scratch / "b.cache"));
}

TEST(CacheFile, SharedArraysOutliveTheFilesName) {
    const TempFolder scratch;
    write(scratch / "a.cache", something());
    const Everything thing = read(scratch / "a.cache");
    std::filesystem::remove(scratch / "a.cache");
    EXPECT_EQ(thing.halves, something().halves);
}

TEST(CacheFile, RefusesEveryByteThatChanged) {
    const TempFolder scratch;
    write(scratch / "a.cache", something());
    const std::string good = bytes_of(scratch / "a.cache");
    for (size_t at = 0; at < good.size(); ++at) {
        std::string bad = good;
        bad[at] ^= 16;
        scratch.put("a.cache", bad);
        EXPECT_THAT(
            error_message(ExitCode::refused, [&] { check_body(*open_cache_file(scratch / "a.cache", made_from)); }),
            HasSubstr("damaged"))
            << at;
    }
}

TEST(CacheFile, RefusesOneThatIsCutOrLonger) {
    const TempFolder scratch;
    write(scratch / "a.cache", something());
    const std::string good = bytes_of(scratch / "a.cache");
    for (const std::string& bad :
         {std::string(), good.substr(0, 60), good.substr(0, 128), good.substr(0, good.size() - 1), good + "x"}) {
        scratch.put("a.cache", bad);
        EXPECT_THAT(error_message(ExitCode::refused, [&] { open_cache_file(scratch / "a.cache", made_from); }),
                    HasSubstr("a.cache"))
            << bad.size();
    }
    error_message(ExitCode::unreadable, [&] { open_cache_file(scratch / "none.cache", made_from); });
    error_message(ExitCode::unreadable, [&] { open_cache_file(scratch.path(), made_from); });
}

TEST(CacheFile, RefusesAnotherThing) {
    const TempFolder scratch;
    write(scratch / "a.cache", something());
    const std::string other(32, 'b');
    EXPECT_THAT(error_message(ExitCode::refused, [&] { open_cache_file(scratch / "a.cache", other); }),
                HasSubstr("does not match its name"));

    // A body that hashes well, but says more elements than there are, or has other fields than the reader asks for.
    const std::string counts(8, '\x7f');
    const std::string_view piece = counts;
    write_cache_file(scratch / "b.cache", made_from, 0, {&piece, 1});
    std::vector<double> values;
    std::string text;
    CacheReader reader(open_cache_file(scratch / "b.cache", made_from)), again = reader, unread = reader;
    EXPECT_THAT(error_message(ExitCode::refused, [&] { reader(values); }), HasSubstr("its data ends early"));
    EXPECT_THAT(error_message(ExitCode::refused, [&] { again(text); }), HasSubstr("its data ends early"));
    EXPECT_THAT(error_message(ExitCode::refused, [&] { unread.finish(); }), HasSubstr("extra data at its end"));
}

TEST(MappedFile, TellsAFileThatChanged) {
    const TempFolder scratch;
    scratch.put("a", "some bytes");
    const MappedFile file(scratch / "a");
    EXPECT_EQ(file.bytes(), "some bytes");
    file.check_unchanged();
    std::filesystem::remove(scratch / "a");
    file.check_unchanged();
    EXPECT_EQ(file.bytes(), "some bytes");

    scratch.put("b", "some bytes");
    const MappedFile other(scratch / "b");
    const timespec times[2] = {{1, 0}, {1, 0}};
    ASSERT_EQ(utimensat(AT_FDCWD, scratch.file("b").c_str(), times, 0), 0);
    EXPECT_THAT(error_message(ExitCode::unreadable, [&] { other.check_unchanged(); }), HasSubstr("was changed"));
}

TEST(MappedFile, HoldsNothingOfAnEmptyFile) {
    const TempFolder scratch;
    scratch.put("a", "");
    EXPECT_EQ(MappedFile(scratch / "a").bytes(), "");
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(MappedFileDeathTest, ACutFileEndsTheProcessWithItsName) {
    const TempFolder scratch;
    scratch.put("first", "x");
    const std::string big(1 << 20, 'x');
    scratch.put("second", big);
    { const MappedFile gone(scratch / "first"); } // its place in the list is used again
    const MappedFile first(scratch / "first"), second(scratch / "second");
    EXPECT_EXIT(
        {
            std::filesystem::resize_file(scratch / "second", 10);
            if (second.bytes().back() == 'x') std::abort();
        },
        testing::ExitedWithCode(static_cast<int>(ExitCode::unreadable)), "tyndall: error: .*second: was truncated");
}

TEST(MappedFileDeathTest, OtherFaultsStayFaults) {
    const TempFolder scratch;
    scratch.put("a", "x");
    const MappedFile file(scratch / "a");
    EXPECT_EXIT(raise(SIGBUS), testing::KilledBySignal(SIGBUS), "");
}
#endif
}
}
