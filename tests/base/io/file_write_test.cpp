#include "base/io/file.h"
#include "base/io/temporary.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <thread>

namespace tyndall {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(FileWrite, WritesEveryByteAndNothingElse) {
    const TempFolder scratch;
    std::string bytes(3 << 20, '\0');
    for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 2654435761u >> 13);
    write_file_atomically(scratch / "f", bytes);
    EXPECT_EQ(bytes_of(scratch / "f"), bytes);
    write_file_atomically(scratch / "f", std::as_bytes(std::span(bytes).first(7)));
    EXPECT_EQ(bytes_of(scratch / "f"), bytes.substr(0, 7));
    write_file_atomically(scratch / "f", std::string_view());
    EXPECT_EQ(bytes_of(scratch / "f"), "");
    EXPECT_THAT(scratch.names(), ElementsAre("f"));
}

TEST(FileWrite, GivesTheRightsOfAnyNewFile) {
    const TempFolder scratch;
    const mode_t before = umask(027);
    write_file_atomically(scratch / "f", "x");
    umask(before);
    struct stat info;
    ASSERT_EQ(stat((scratch / "f").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0640u);
}

TEST(FileWrite, WorksInTheCurrentDirectory) {
    const TempFolder scratch;
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(scratch.path());
    check_output("plain.txt");
    write_file_atomically("plain.txt", "x");
    std::filesystem::current_path(before);
    EXPECT_THAT(scratch.names(), ElementsAre("plain.txt"));
}

TEST(FileWrite, TakesTheLongestNameThereIs) {
    const TempFolder scratch;
    const std::string longest(255, 'n');
    check_output(scratch / longest);
    write_file_atomically(scratch / longest, "x");
    EXPECT_EQ(bytes_of(scratch / longest), "x");
    for (const auto& write :
         {check_output, +[](const std::filesystem::path& path) { write_file_atomically(path, "x"); }})
        EXPECT_THAT(error_message(ExitCode::unwritable, [&] { write(scratch / std::string(256, 'n')); }),
                    HasSubstr("too long"));
    EXPECT_THAT(scratch.names(), SizeIs(1));
}

TEST(FileWrite, KeepsASymbolicLinkAndReplacesItsTarget) {
    const TempFolder scratch;
    std::filesystem::create_directory(scratch / "real");
    std::filesystem::create_symlink("real/target", scratch / "link");
    scratch.put("real/target", "old");
    write_file_atomically(scratch / "link", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(scratch / "link"));
    EXPECT_EQ(bytes_of(scratch / "real/target"), "new");
}

TEST(FileWrite, RefusesNamesThatARenameWouldDestroy) {
    const TempFolder scratch;
    const auto pipe = scratch / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::filesystem::create_directory(scratch / "directory");
    std::filesystem::create_symlink("/dev/null", scratch / "null");
    for (const auto& write :
         {check_output, +[](const std::filesystem::path& path) { write_file_atomically(path, "x"); }}) {
        const auto text = [&](const std::filesystem::path& path) {
            return error_message(ExitCode::unwritable, [&] { write(path); });
        };
        EXPECT_THAT(text(scratch / "directory"), HasSubstr("is a directory"));
        EXPECT_THAT(text(pipe), HasSubstr("device or pipe"));
        EXPECT_THAT(text(scratch / "null"), HasSubstr("device or pipe"));
        EXPECT_THAT(text("/dev/null"), HasSubstr("device or pipe"));
        EXPECT_THAT(text(scratch / "directory/"), HasSubstr("not a file name"));
        EXPECT_THAT(text(""), HasSubstr("not a file name"));
        EXPECT_THAT(text(std::string("a\0b", 3)), HasSubstr("zero byte"));
    }
    struct stat info;
    ASSERT_EQ(stat("/dev/null", &info), 0);
    EXPECT_TRUE(S_ISCHR(info.st_mode));
    EXPECT_THAT(scratch.names(), SizeIs(3));
}

TEST(FileWrite, ADirectoryThatIsMissingOrGoneAgainIsMade) {
    const TempFolder scratch;
    const auto path = scratch / "a/b/c.exr";
    check_output(path);
    EXPECT_TRUE(std::filesystem::is_empty(scratch / "a/b"));
    std::filesystem::remove_all(scratch / "a"); // as another process does that made it and failed
    write_file_atomically(path, "x");
    EXPECT_EQ(bytes_of(path), "x");
    scratch.put("file", "");
    EXPECT_THAT(error_message(ExitCode::unwritable, [&] { check_output(scratch / "file/below.exr"); }),
                HasSubstr("cannot create its directory: Not a directory"));
}

TEST(FileWrite, CheckLeavesAnExistingFileAlone) {
    const TempFolder scratch;
    check_output(scratch.put("f", "kept"));
    EXPECT_EQ(bytes_of(scratch / "f"), "kept");
    EXPECT_THAT(scratch.names(), ElementsAre("f"));
}

// A full disk as the kernel reports it in the middle of a write: the file size limit of the process.
TEST(FileWrite, AWriteThatFailsHalfwayLeavesTheOldFileAndNoTemporary) {
    const TempFolder scratch;
    const auto path = scratch.put("f", "old");
    rlimit before;
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    const rlimit small{100000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string text =
        error_message(ExitCode::unwritable, [&] { write_file_atomically(path, std::string(100001, 'x')); });
    write_file_atomically(scratch / "fits", std::string(100000, 'x'));
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    EXPECT_EQ(text, path.string() + ": cannot write: File too large");
    EXPECT_EQ(bytes_of(path), "old");
    EXPECT_EQ(bytes_of(scratch / "fits").size(), 100000u);
    EXPECT_THAT(scratch.names(), SizeIs(2));
}

TEST(FileWrite, AFullDiskLeavesTheOldFileAndNoTemporary) {
    const TempFolder scratch;
    std::filesystem::create_directory(scratch / "disk");
    const auto path = scratch / "disk/f";
    if (mount("tyndall_test", (scratch / "disk").c_str(), "tmpfs", 0, "size=64k") != 0)
        GTEST_SKIP() << "no right to mount a small file system";
    write_file_atomically(path, "old");
    const std::string text =
        error_message(ExitCode::unwritable, [&] { write_file_atomically(path, std::string(1 << 20, 'x')); });
    const std::string left = bytes_of(path);
    const auto files = std::distance(std::filesystem::directory_iterator(scratch / "disk"), {});
    ASSERT_EQ(umount((scratch / "disk").c_str()), 0);
    EXPECT_EQ(text, path.string() + ": cannot write: No space left on device");
    EXPECT_EQ(left, "old");
    EXPECT_EQ(files, 1);
}

TEST(FileWrite, AnUnwritableDirectoryIsFoundByTheCheck) {
    const std::string text = error_message(ExitCode::unwritable, [] { check_output("/proc/tyndall.exr"); });
    EXPECT_THAT(text, testing::StartsWith("/proc/tyndall.exr: cannot create a file in its directory: "));
}

TEST(FileWrite, AReaderNeverSeesHalfAFile) {
    const TempFolder scratch;
    const auto path = scratch / "f";
    const std::string a(200000, 'a'), b(300000, 'b');
    write_file_atomically(path, a);
    std::atomic<bool> done = false;
    std::vector<std::thread> writers;
    for (const std::string* text : {&a, &b})
        writers.emplace_back([&, text] {
            while (!done) write_file_atomically(path, *text);
        });
    int torn = 0;
    for (int i = 0; i < 300; ++i) {
        const std::string seen = read_file(path);
        torn += seen != a && seen != b;
    }
    done = true;
    for (std::thread& writer : writers) writer.join();
    EXPECT_EQ(torn, 0);
    EXPECT_THAT(scratch.names(), ElementsAre("f"));
}

// Runs `action` in another process, which dies of it.
template<class Action> void run_and_kill(Action action) {
    const pid_t child = fork();
    if (child == 0) {
        action();
        raise(SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
}

void age(const std::filesystem::path& path, long hours) {
    const timespec times[2] = {{0, UTIME_OMIT}, {time(nullptr) - 3600 * hours, 0}};
    ASSERT_EQ(utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
}

TEST(Sweep, RemovesWhatAKilledRunLeftAndOnlyThat) {
    const TempFolder scratch;
    run_and_kill([&] {
        Temporary temporary(scratch / "frame.0001.exr");
        temporary.write("half", 4);
        raise(SIGKILL);
    });
    ASSERT_THAT(scratch.names(), SizeIs(1));
    const std::string left = scratch.names()[0];
    EXPECT_THAT(left, testing::MatchesRegex("\\.frame\\.0001\\.exr\\..+\\.[0-9]+-[0-9]+\\.[0-9a-f]+\\.tmp"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "frame.0001.exr"));

    // Names like ours that another program or another machine may own, all of them old.
    const std::string owner = left.substr(left.size() - 4 - 17), tag = owner.substr(0, 17); // ".<16 hex>.tmp"
    std::vector<std::string> others = {
        "notes.tmp",    ".hidden",  ".a.exr.otherhost.4026531836-999999999" + tag + ".tmp",
        left.substr(1), left + "x", left.substr(0, left.size() - 4)};
    for (const std::string& name : others) {
        scratch.put(name, "");
        age(scratch / name, 100);
    }
    others.push_back("." + left);
    std::filesystem::create_directory(scratch / others.back());

    sweep_temporaries(scratch.path());
    EXPECT_THAT(scratch.names(), testing::UnorderedElementsAreArray(others));
}

TEST(Sweep, LeavesARunningProcessAloneForADay) {
    const TempFolder scratch;
    const Temporary temporary(scratch / "f");
    const std::string name = scratch.names().at(0);
    sweep_temporaries(scratch.path());
    EXPECT_THAT(scratch.names(), ElementsAre(name));
    age(scratch / name, 23);
    sweep_temporaries(scratch.path());
    EXPECT_THAT(scratch.names(), ElementsAre(name));
    age(scratch / name, 25);
    sweep_temporaries(scratch.path());
    EXPECT_THAT(scratch.names(), IsEmpty());
}

TEST(Sweep, JudgesProcessesOfItsOwnNamespaceOnly) {
    const TempFolder scratch;
    run_and_kill([&] {
        const Temporary temporary(scratch / "f");
        raise(SIGKILL);
    });
    std::string name = scratch.names().at(0);
    const size_t dash = name.rfind('-'), dot = name.rfind('.', dash);
    const std::string elsewhere = name.substr(0, dot) + ".1-" + name.substr(dash + 1);
    std::filesystem::rename(scratch / name, scratch / elsewhere);
    sweep_temporaries(scratch.path());
    EXPECT_THAT(scratch.names(), ElementsAre(elsewhere));
    age(scratch / elsewhere, 25);
    sweep_temporaries(scratch.path());
    EXPECT_THAT(scratch.names(), IsEmpty());
}

TEST(Sweep, AMissingDirectoryIsNoError) { sweep_temporaries("/nowhere/at/all"); }
}
}
