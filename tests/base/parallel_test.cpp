#include "base/cores.h"
#include "base/parallel.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace tyndall {
namespace {
TEST(Parallel, CallsTheBodyOnceForEveryIndex) {
    for (const int64_t count : {-5, 0, 1, 2, 1000, 100000}) {
        std::vector<std::atomic<int>> calls(static_cast<size_t>(std::max<int64_t>(count, 0)));
        parallel_for(count, [&](int64_t i) { ++calls.at(static_cast<size_t>(i)); });
        for (const auto& number : calls) ASSERT_EQ(number, 1);
    }
}

TEST(Parallel, PiecesCoverTheRangeAndAreNeverSmallerThanTheGrain) {
    for (const int64_t count : {0, 1, 7, 64, 1000, 12345}) {
        for (const int64_t grain : {1, 2, 10, 64, 999, 100000}) {
            std::vector<std::atomic<int>> calls(static_cast<size_t>(count));
            std::atomic<int64_t> smallest = INT64_MAX;
            parallel_ranges(count, grain, [&](int64_t begin, int64_t end) {
                ASSERT_LT(begin, end);
                for (int64_t seen = smallest;
                     end - begin < seen && !smallest.compare_exchange_weak(seen, end - begin);) {}
                for (int64_t i = begin; i < end; ++i) ++calls.at(static_cast<size_t>(i));
            });
            for (const auto& number : calls) ASSERT_EQ(number, 1) << count << " by " << grain;
            EXPECT_GE(smallest, std::min(grain, count)) << count << " by " << grain;
        }
    }
}

// Waits for something another thread does, at most ten seconds.
bool happens(const auto& condition) {
    for (int i = 0; i < 10000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return condition();
}

TEST(Parallel, RunsBodiesTogetherAndWhoIsDoneHelps) {
    if (usable_cores() < 2) GTEST_SKIP() << "one core";
    set_thread_count(2);
    std::atomic<bool> begun = false;
    std::mutex mutex;
    std::set<std::thread::id> threads;
    const auto seen = [&] {
        const std::scoped_lock lock(mutex);
        return threads.size();
    };
    // The second body's loop goes on only when both threads work at it, though the first is long over.
    parallel_invoke({[&] { EXPECT_TRUE(happens([&] { return begun.load(); })); },
                     [&] {
                         begun = true;
                         parallel_for(64, [&](int64_t) {
                             {
                                 const std::scoped_lock lock(mutex);
                                 threads.insert(std::this_thread::get_id());
                             }
                             EXPECT_TRUE(happens([&] { return seen() == 2; }));
                         });
                     }});
    set_thread_count(0);
    EXPECT_EQ(seen(), 2u);
}

TEST(Parallel, RunsEveryBodyOnceOnOneThread) {
    for (const int count : {1, 2}) {
        set_thread_count(count);
        std::atomic<int> calls = 0;
        parallel_invoke({});
        parallel_invoke({[&] { ++calls; }, [&] { calls += 10; }, [&] { calls += 100; }});
        EXPECT_EQ(calls, 111);
        EXPECT_THROW(parallel_invoke({[] {}, [] { throw std::runtime_error("no"); }}), std::runtime_error);
    }
    set_thread_count(0);
}

TEST(Parallel, AnExceptionStopsTheLoopAndArrivesUnchanged) {
    struct Special : std::runtime_error {
        int number;
        explicit Special(int number_) : std::runtime_error("special"), number(number_) {}
    };
    std::atomic<int64_t> calls = 0;
    try {
        parallel_for(10000000, [&](int64_t i) {
            ++calls;
            if (i == 17) throw Special(42);
        });
        FAIL() << "nothing was thrown";
    } catch (const Special& error) {
        EXPECT_EQ(error.number, 42);
    }
    EXPECT_LT(calls, 10000000);
    std::atomic<int> after = 0;
    parallel_for(100, [&](int64_t) { ++after; });
    EXPECT_EQ(after, 100);
}

TEST(Parallel, AnExceptionPassesThroughNestedLoops) {
    const auto nested = [] {
        parallel_for(50, [&](int64_t i) {
            parallel_for(50, [&](int64_t j) {
                if (i == 20 && j == 30) throw std::runtime_error("inner");
            });
        });
    };
    EXPECT_THROW(nested(), std::runtime_error);
}

// A waiting thread that took up another outer piece would come back to a lock it already holds. More threads than cores
// and heterogeneous inner pieces make them wait for each other.
TEST(Parallel, AnOuterBodyIsNeverEnteredTwiceOnOneStack) {
    set_thread_count(8);
    std::atomic<int64_t> total = 0;
    std::atomic<int> entered_again = 0;
    const auto outer_body = [&](int64_t i) {
        thread_local bool inside = false;
        if (inside) ++entered_again;
        inside = true;
        parallel_for(8, [&](int64_t j) {
            std::this_thread::sleep_for(std::chrono::microseconds((i + j) % 8 == 0 ? 2000 : 50));
            total += j;
        });
        inside = false;
    };
    tbb::task_arena(8).execute([&] { parallel_for(1000, outer_body); });
    set_thread_count(0);
    EXPECT_EQ(entered_again, 0);
    EXPECT_EQ(total, 1000 * 28);
}

TEST(Parallel, ResultsLandInTheirPlaceForAnyThreadCount) {
    const int before = thread_count();
    std::vector<double> results[3];
    const int counts[] = {1, 2, 7};
    for (size_t k = 0; k < 3; ++k) {
        set_thread_count(counts[k]);
        EXPECT_EQ(thread_count(), counts[k]);
        results[k].resize(5000);
        parallel_for(5000, [&](int64_t i) { results[k][static_cast<size_t>(i)] = 1.0 / static_cast<double>(i + 1); });
    }
    set_thread_count(before);
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

TEST(Parallel, OneThreadMeansOne) {
    set_thread_count(1);
    const auto caller = std::this_thread::get_id();
    std::atomic<int> elsewhere = 0;
    parallel_for(1000, [&](int64_t) { elsewhere += std::this_thread::get_id() != caller; });
    set_thread_count(0);
    EXPECT_EQ(elsewhere, 0);
    EXPECT_EQ(thread_count(), usable_cores());
}

// The pool is used before, so its threads exist with their old settings: every later task must still flush.
TEST(Parallel, DenormalsAreFlushedOnEveryThread) {
    set_thread_count(4);
    std::atomic<int> tasks = 0;
    parallel_for(2000, [&](int64_t) { ++tasks; });
    const unsigned before = _mm_getcsr();
    flush_denormals();
    std::atomic<int> kept = 0;
    const volatile float smallest_normal = 1.17549435e-38f;
    for (int round = 0; round < 20; ++round) parallel_for(2000, [&](int64_t) { kept += smallest_normal * 0.5f != 0; });
    parallel_for(20, [&](int64_t) { parallel_for(50, [&](int64_t) { kept += smallest_normal * 0.5f != 0; }); });
    _mm_setcsr(before);
    set_thread_count(0);
    EXPECT_EQ(kept, 0);
}

TEST(Cores, AtLeastOneAndNoMoreThanTheAffinityMask) {
    cpu_set_t before, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    EXPECT_GE(usable_cores(), 1);
    EXPECT_LE(usable_cores(), CPU_COUNT(&before));
    CPU_ZERO(&one);
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
        if (CPU_ISSET(cpu, &before)) {
            CPU_SET(cpu, &one);
            break;
        }
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(usable_cores(), 1);
    sched_setaffinity(0, sizeof before, &before);
}

TEST(Cores, ProcessorTimeOfAControlGroup) {
    EXPECT_EQ(granted_cores("max 100000"), 0);
    EXPECT_EQ(granted_cores("200000 100000"), 2);
    EXPECT_EQ(granted_cores("150000 100000"), 2);
    EXPECT_EQ(granted_cores("1000 100000"), 1);
    for (const char* nonsense :
         {"", "max", "100000", "100000 0", "-1 100000", "0 100000", "a b", "99999999999999999999 1"})
        EXPECT_EQ(granted_cores(nonsense), 0) << nonsense;
}
}
}
