#include "base/io/file.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>

namespace tyndall {
namespace {
using testing::HasSubstr;

TEST(FileRead, ReturnsEveryByteWithZerosAndLineEnds) {
    const TempFolder scratch;
    const std::string bytes("a\0b\r\n\xff\x1a", 7);
    EXPECT_EQ(read_file(scratch.put("f", bytes)), bytes);
    EXPECT_EQ(read_file(scratch.put("empty", "")), "");
    EXPECT_EQ(check_readable(scratch / "f"), 7u);
    EXPECT_EQ(check_readable(scratch / "empty"), 0u);
}

TEST(FileRead, ReadsFilesThatAnnounceNoSize) { EXPECT_THAT(read_file("/proc/self/status"), HasSubstr("Pid:")); }

TEST(FileRead, RefusesMoreThanTheLimitAndTakesExactlyTheLimit) {
    const TempFolder scratch;
    const auto path = scratch.put("f", std::string(1000, 'x'));
    EXPECT_EQ(read_file(path, 1000).size(), 1000u);
    EXPECT_THAT(error_message(ExitCode::refused, [&] { read_file(path, 999); }), HasSubstr("larger than 999 bytes"));
    EXPECT_THAT(error_message(ExitCode::refused, [] { read_file("/proc/self/status", 10); }),
                HasSubstr("larger than 10"));
}

TEST(FileRead, RefusesAHugeSparseFileWithoutReadingIt) {
    const TempFolder scratch;
    const auto path = scratch.put("sparse", "");
    ASSERT_EQ(truncate(path.c_str(), off_t{20} << 30), 0);
    EXPECT_THAT(error_message(ExitCode::refused, [&] { read_file(path); }), HasSubstr("larger than 67108864 bytes"));
    EXPECT_EQ(check_readable(path), uint64_t{20} << 30);
}

TEST(FileRead, NamesWhatIsNoFile) {
    const TempFolder scratch;
    const auto pipe = scratch / "pipe", socket_path = scratch / "socket";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, socket_path.c_str(), sizeof address.sun_path - 1);
    ASSERT_EQ(bind(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    close(descriptor);
    std::filesystem::create_symlink("nowhere", scratch / "dangling");

    const auto text = [](const std::filesystem::path& path) {
        const std::string from_check = error_message(ExitCode::unreadable, [&] { check_readable(path); });
        EXPECT_EQ(error_message(ExitCode::unreadable, [&] { read_file(path); }), from_check);
        EXPECT_THAT(from_check, testing::StartsWith(path.string() + ": "));
        return from_check;
    };
    EXPECT_THAT(text(scratch / "absent"), HasSubstr("no such file"));
    EXPECT_THAT(text(scratch / "dangling"), HasSubstr("no such file"));
    EXPECT_THAT(text(scratch.path()), HasSubstr("is a directory"));
    EXPECT_THAT(text(pipe), HasSubstr("not a regular file"));
    EXPECT_THAT(text("/dev/zero"), HasSubstr("not a regular file"));
    EXPECT_THAT(text(socket_path), HasSubstr("No such device"));
    EXPECT_THAT(text(scratch.put("file", "") / "below"), HasSubstr("Not a directory"));
}

TEST(FileRead, SaysWhenPermissionIsMissing) {
    const TempFolder scratch;
    const auto path = scratch.put("secret", "x");
    ASSERT_EQ(chmod(path.c_str(), 0), 0);
    // Root may read everything, so it reads as nobody.
    const bool root = geteuid() == 0;
    ASSERT_TRUE(!root || (chmod(scratch.path().c_str(), 0755) == 0 && seteuid(65534) == 0));
    const std::string text = error_message(ExitCode::unreadable, [&] { read_file(path); });
    ASSERT_TRUE(!root || seteuid(0) == 0);
    EXPECT_THAT(text, HasSubstr("Permission denied"));
}

// Published results of MurmurHash3_x64_128 with seed 0.
TEST(ContentHash, OfPiecesIsThatOfTheWhole) {
    std::string whole;
    for (int i = 0; i < 300; ++i) whole += static_cast<char>(i * 7);
    for (const size_t length : {1, 5, 15, 16, 17, 31, 100, 300}) {
        std::vector<std::string_view> pieces{""};
        for (size_t at = 0; at < whole.size(); at += length)
            pieces.push_back(std::string_view(whole).substr(at, length));
        EXPECT_EQ(content_hash(pieces), content_hash(whole)) << length;
    }
}

TEST(ContentHash, MatchesThePublishedFunction) {
    EXPECT_EQ(content_hash(""), "00000000000000000000000000000000");
    EXPECT_EQ(content_hash("hello"), "cbd8a7b341bd9b025b1e906a48ae1d19");
    EXPECT_EQ(content_hash("The quick brown fox jumps over the lazy dog"), "e34bbc7bbc071b6c7a433ca9c49a9347");
}

int differing_bits(const std::string& a, const std::string& b) {
    int count = 0;
    for (size_t i = 0; i < a.size(); i += 16)
        count +=
            __builtin_popcountll(std::stoull(a.substr(i, 16), nullptr, 16) ^ std::stoull(b.substr(i, 16), nullptr, 16));
    return count;
}

// Of 128 bits about 64 flip (binomial, standard deviation 5.7); the mean over n bits then lies within 5·5.7/√n of 64.
TEST(ContentHash, EveryInputBitReachesTheWholeResultAtEveryLength) {
    for (size_t length = 1; length <= 40; ++length) {
        std::string bytes(length, '\0');
        for (size_t i = 0; i < length; ++i) bytes[i] = static_cast<char>(37 * i + 11);
        const std::string before = content_hash(bytes);
        double total = 0;
        for (size_t bit = 0; bit < 8 * length; ++bit) {
            bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
            const int flipped = differing_bits(before, content_hash(bytes));
            EXPECT_GT(flipped, 30) << "length " << length << " bit " << bit;
            total += flipped;
            bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
        }
        const double bits = 8.0 * static_cast<double>(length);
        EXPECT_NEAR(total / bits, 64, 5 * 5.7 / std::sqrt(bits)) << "length " << length;
    }
}

TEST(ContentHash, TellsZerosOfDifferentLengthApart) {
    std::vector<std::string> hashes;
    for (size_t length = 0; length < 300; ++length) hashes.push_back(content_hash(std::string(length, '\0')));
    std::sort(hashes.begin(), hashes.end());
    EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}
}
}
