// Random damage: every file ends as fog or as an Error, in bounded time and memory. Each is read in a process of its
// own.
#include "support/corpus.h"
#include "support/threads.h"
#include "volume/vdb/nano/fixtures.h"
#include "volume/vdb/vdb.h"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>

namespace tyndall {
namespace {
using namespace testing;

template<class T> void overwrite(std::string& bytes, size_t position, T value) {
    if (position + sizeof value <= bytes.size()) bytes = patched(std::move(bytes), position, value);
}

// One to four faults: bits, extreme numbers, bytes lost or doubled. Half of them hit the first 1400 bytes.
std::string mutated(std::string bytes, std::mt19937& random) {
    constexpr int64_t extremes[] = {0, -1, 1, INT32_MAX, INT32_MIN, INT64_MAX, INT64_MIN, 0x10000, int64_t{1} << 40};
    const auto below = [&](size_t limit) { return limit > 0 ? random() % limit : 0; };
    for (size_t faults = 1 + below(4); faults > 0; --faults) {
        const size_t range = below(2) ? bytes.size() : std::min<size_t>(bytes.size(), 1400), position = below(range);
        const int64_t extreme = extremes[below(std::size(extremes))];
        switch (below(6)) {
        case 0:
            overwrite(bytes, position, static_cast<uint8_t>(bytes[position] ^ (1 << below(8))));
            break;
        case 1:
            overwrite(bytes, position, static_cast<uint8_t>(below(256)));
            break;
        case 2:
            overwrite(bytes, position, static_cast<int32_t>(extreme));
            break;
        case 3:
            overwrite(bytes, position, extreme);
            break;
        case 4:
            bytes.erase(position, 1 + below(64));
            break;
        default:
            bytes.insert(position, bytes.substr(position, 1 + below(64)));
        }
        if (bytes.empty()) break;
    }
    return bytes;
}

enum Outcome { loaded, refused, wrong };
constexpr int first_code = 40; // exit codes no sanitizer uses

// What became of a file read by a child: its outcome, or `wrong` with the reason.
struct Verdict {
    Outcome outcome = wrong;
    std::string why;
};

Outcome read_all(const std::filesystem::path& file) {
    const Error info = error_of([&] { vdb_info(file); });
    const Error read = error_of([&] { read_vdb(file); });
    for (const Error* error : {&info, &read})
        if (error->code != ExitCode::ok && error->code != ExitCode::refused) return wrong;
    return read.code == ExitCode::ok ? loaded : refused;
}

Verdict judged(const std::filesystem::path& file) {
    const pid_t child = fork();
    if (child == 0) {
        alarm(10);
        _exit(first_code + read_all(file));
    }
    int status = 0;
    rusage usage{};
    if (child < 0 || wait4(child, &status, 0, &usage) != child) return {wrong, "no child"};
    if (WIFSIGNALED(status)) return {wrong, "signal " + std::to_string(WTERMSIG(status))};
    if (usage.ru_maxrss > 2 << 20) return {wrong, "memory " + std::to_string(usage.ru_maxrss >> 10) + " MB"};
    const int outcome = WEXITSTATUS(status) - first_code;
    if (outcome != loaded && outcome != refused) return {wrong, "exit code " + std::to_string(WEXITSTATUS(status))};
    return {static_cast<Outcome>(outcome), ""};
}

std::vector<std::string> originals() {
    std::vector<std::string> files;
    for (const uint32_t packing : {pack_none, pack_mask, pack_mask | pack_zip, pack_mask | pack_blosc})
        for (const bool offsets : {true, false}) {
            AuthoredGrid ball = noisy_ball({3, 0, 4094}, 8), second = noisy_ball(ivec3(0), 5);
            ball.half = offsets, second.name = "heat", second.type = offsets ? "vec3s" : "double";
            ball.tiles = {{ivec3(64), 1, 0.5f}, {ivec3(256), 2, 0.5f}, {ivec3(8192), 3, 0.5f}};
            files.push_back(authored({ball, second}, packing, offsets));
        }
    for (const NanoPacking packing : {NanoPacking::none, NanoPacking::zip, NanoPacking::blosc}) {
        AuthoredGrid ball = noisy_ball({3, 0, 4094}, 8);
        ball.tiles = {{ivec3(64), 1, 0.5f}, {ivec3(256), 2, 0.5f}, {ivec3(8192), 3, 0.5f}};
        for (const NanoStore store : {NanoStore::plain, NanoStore::fp8, NanoStore::fpn})
            files.push_back(nano_authored({ball}, packing, store));
    }
    for (const std::filesystem::path& file :
         test::corpus_files_named({"vdb/vpt/dragon.vdb", "vdb/openusd/smoke_000001.vdb", "vdb/arnold/grids.vdb"}))
        files.push_back(bytes_of(file));
    return files;
}

void mutate(int count, uint32_t seed) {
    const Threads alone(1); // a child of a process whose workers are about may wait for them forever
    const TempFolder scratch;
    const std::vector<std::string> files = originals();
    std::mt19937 random(seed);
    int outcomes[3] = {};
    for (int i = 0; i < count; ++i) {
        const auto file = scratch.put("mutant.vdb", mutated(files[static_cast<size_t>(i) % files.size()], random));
        const Verdict verdict = judged(file);
        ++outcomes[verdict.outcome];
        if (verdict.outcome != wrong) continue;
        const auto kept = std::filesystem::temp_directory_path() / ("tyndall_mutant_" + std::to_string(i) + ".vdb");
        std::filesystem::copy_file(file, kept, std::filesystem::copy_options::overwrite_existing);
        ADD_FAILURE() << verdict.why << ", see " << kept;
    }
    EXPECT_GT(outcomes[refused], count / 2);
    EXPECT_GT(outcomes[loaded], 0);
    ::testing::Test::RecordProperty("loaded", outcomes[loaded]);
    ::testing::Test::RecordProperty("refused", outcomes[refused]);
    std::printf("%d files: %d loaded, %d refused, %d wrong\n", count, outcomes[loaded], outcomes[refused],
                outcomes[wrong]);
}

TEST(VdbMutation, FewFiles) { mutate(40, 1); }
TEST(VdbMutation, NightlyManyFiles) { mutate(500, 2); }
}
}
