#include "base/io/cache_folder.h"
#include "base/io/file.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

struct Heavy {
    std::vector<float> values;
};
template<class Visit> void fields(Heavy& thing, Visit& visit) { visit(thing.values); }

std::shared_ptr<CacheFolder> to_write(const TempFolder& scratch, uint64_t room = 1 << 20) {
    auto folder = std::make_shared<CacheFolder>(scratch.path());
    folder->writes = true, folder->room = room;
    return folder;
}

std::shared_ptr<CacheFolder> to_read(const CacheFolder& written, std::filesystem::path local = {}) {
    auto folder = std::make_shared<CacheFolder>(written.folder, std::move(local));
    folder->build = written.build, folder->files = written.files;
    return folder;
}

// How often it had to be made; its values begin with a number.
struct Maker {
    int made = 0;
    Heavy operator()() { return ++made, Heavy{{static_cast<float>(made), 2, 3}}; }
};

float ask(CacheFolder* folder, Maker& maker, const std::string& content = "x") {
    return load_or_build<Heavy>(folder, "heavy thing", content, [&] { return maker(); }).values[0];
}

TEST(CacheFolder, ThingsAreMadeOnceAndFound) {
    const TempFolder scratch;
    const auto folder = to_write(scratch);
    Maker maker;
    EXPECT_EQ(ask(folder.get(), maker), 1);
    EXPECT_EQ(ask(folder.get(), maker), 1);
    EXPECT_EQ(ask(to_read(*folder).get(), maker), 1);
    EXPECT_EQ(ask(folder.get(), maker, "y"), 2);
    ASSERT_THAT(folder->costs, SizeIs(3));
    EXPECT_EQ(folder->costs[0].kind, CostKind::cached);
    EXPECT_EQ(folder->costs[1].kind, CostKind::found);
    EXPECT_EQ(folder->costs[1].seconds, folder->costs[0].seconds);
    EXPECT_EQ(folder->costs[0].file, cache_file_name("heavy thing", made_from_hash(*folder, "heavy thing", "x")));
    EXPECT_THAT(folder->costs[0].file, testing::MatchesRegex("heavy-thing-[0-9a-f]+.cache"));
    EXPECT_THAT(scratch.names(), SizeIs(2));
}

TEST(CacheFolder, AnotherBuildFindsNothing) {
    const TempFolder scratch;
    const auto folder = to_write(scratch), other = to_read(*folder);
    Maker maker;
    ask(folder.get(), maker);
    other->build = "another";
    EXPECT_EQ(ask(other.get(), maker), 2);
}

TEST(CacheFolder, WithoutFolderOrContentThingsAreMade) {
    const TempFolder scratch;
    const auto folder = to_write(scratch);
    Maker maker;
    EXPECT_EQ(ask(nullptr, maker), 1);
    EXPECT_EQ(ask(folder.get(), maker, ""), 2);
    EXPECT_EQ(load_or_build<int>(folder.get(), "number", "x", [] { return 5; }), 5); // it has no fields
    ASSERT_THAT(folder->costs, SizeIs(2));
    EXPECT_EQ(folder->costs[1].what, "number");
    EXPECT_EQ(folder->costs[1].kind, CostKind::rebuilt);
    EXPECT_THAT(scratch.names(), SizeIs(0));
}

TEST(CacheFolder, WhatDoesNotFitIsNotWritten) {
    const TempFolder scratch;
    const auto folder = to_write(scratch, 300);
    Maker maker;
    ask(folder.get(), maker, "x"), ask(folder.get(), maker, "y");
    EXPECT_EQ(folder->costs.at(0).kind, CostKind::cached);
    EXPECT_EQ(folder->costs.at(1).kind, CostKind::no_room);
    EXPECT_THAT(scratch.names(), SizeIs(1));
}

TEST(CacheFolder, FilesThatAreGoneCutOrOthersAreNamed) {
    const TempFolder scratch;
    const auto written = to_write(scratch);
    Maker maker;
    ask(written.get(), maker);
    const std::string name = scratch.names()[0], good = bytes_of(scratch / name);
    const auto text_of = [&](ExitCode code) {
        return error_message(code, [&] { ask(to_read(*written).get(), maker); });
    };
    scratch.put(name, good.substr(0, 20));
    EXPECT_THAT(text_of(ExitCode::unreadable),
                testing::AllOf(HasSubstr(name), HasSubstr("is truncated or was replaced: has 20 of")));
    std::string bad = good;
    bad.back() ^= 1;
    scratch.put(name, bad); // its time stamp tells
    EXPECT_THAT(text_of(ExitCode::refused), HasSubstr("damaged"));
    error_message(ExitCode::refused, [&] { check_cache_file(*written, name, written->files.at(name)); });
    Heavy other{{7, 7, 7}};
    CacheWriter writer;
    fields(other, writer);
    write_cache_file(scratch / name, made_from_hash(*written, "heavy thing", "x"), 0, writer.pieces());
    EXPECT_THAT(text_of(ExitCode::refused), HasSubstr("is not the file that was prepared"));
    std::filesystem::remove(scratch / name);
    EXPECT_THAT(text_of(ExitCode::unreadable), HasSubstr("no such file"));

    scratch.put(name, good); // another time stamp alone does no harm
    EXPECT_EQ(ask(to_read(*written).get(), maker), 1);
    EXPECT_EQ(maker.made, 1);
}

TEST(CacheFolder, CopiesAreMadeOnce) {
    const TempFolder scratch, local;
    const auto written = to_write(scratch);
    Maker maker;
    ask(written.get(), maker);
    const std::string name = scratch.names()[0];
    EXPECT_EQ(ask(to_read(*written, local.path()).get(), maker), 1);
    EXPECT_THAT(local.names(), ElementsAre(name));
    const FileStamp stamp = stamp_of(local / name);
    std::filesystem::remove(scratch / name);
    EXPECT_EQ(ask(to_read(*written, local.path()).get(), maker), 1);
    EXPECT_EQ(stamp_of(local / name), stamp);
    EXPECT_EQ(maker.made, 1);

    std::string bad = bytes_of(local / name);
    bad.back() ^= 1;
    scratch.put(name, bad);
    std::filesystem::remove(local / name);
    error_message(ExitCode::refused, [&] { ask(to_read(*written, local.path()).get(), maker); });
    EXPECT_THAT(local.names(), SizeIs(0));
}

TEST(CacheFolder, AMappedFileThatChangesIsTold) {
    const TempFolder scratch;
    const auto written = to_write(scratch);
    Maker maker;
    ask(written.get(), maker);
    const std::string name = scratch.names()[0];
    const auto kept = find_cache_file(*written, "heavy thing", made_from_hash(*written, "heavy thing", "x"));
    check_unchanged(*written);
    std::filesystem::last_write_time(scratch / name, std::filesystem::file_time_type());
    EXPECT_THAT(error_message(ExitCode::unreadable, [&] { check_unchanged(*written); }), HasSubstr(name));
}

TEST(FileHashes, AreWorkedOutOnce) {
    const TempFolder scratch;
    scratch.put("a", "one");
    FileHashes files;
    const std::string first = file_hash(scratch / "a", files);
    scratch.put("a", "two");
    EXPECT_EQ(file_hash(scratch / "a", files), first);
    FileHashes again;
    EXPECT_NE(file_hash(scratch / "a", again), first);
    error_message(ExitCode::unreadable, [&] { file_hash(scratch / "b", again); });
}

TEST(FileHashes, OnRecordStandForFilesThatKeepTheirStamps) {
    const TempFolder scratch;
    scratch.put("a", "one");
    FileHashes files;
    const std::string hash = file_hash(scratch / "a", files);
    FileHashes later;
    later.recorded_in = "record";
    later.recorded[normal_path(scratch / "a")] = {stamp_of(scratch / "a"), "on record"};
    EXPECT_EQ(file_hash(scratch / "a", later), "on record"); // not read

    const auto changed = std::filesystem::last_write_time(scratch / "a") + std::chrono::seconds(1);
    std::filesystem::last_write_time(scratch / "a", changed);
    later.known.clear();
    EXPECT_THAT(error_message(ExitCode::refused, [&] { file_hash(scratch / "a", later); }),
                testing::AllOf(HasSubstr("has changed since record"), HasSubstr("prepare again")));
    later.recorded.begin()->second.hash = hash;
    EXPECT_EQ(file_hash(scratch / "a", later), hash);
}
}
}
