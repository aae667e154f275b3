#include "base/clock.h"
#include "base/io/progress.h"
#include "base/json/json.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <sstream>
#include <thread>

namespace tyndall {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

template<class Action> std::string output_of(Action action) {
    testing::internal::CaptureStdout();
    action();
    return testing::internal::GetCapturedStdout();
}

// What a terminal would have been sent on stdout.
template<class Action> std::string terminal_output_of(Action action) {
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    EXPECT_EQ(grantpt(terminal), 0);
    EXPECT_EQ(unlockpt(terminal), 0);
    const int slave = open(ptsname(terminal), O_RDWR | O_NOCTTY);
    std::fflush(stdout);
    const int before = dup(STDOUT_FILENO);
    dup2(slave, STDOUT_FILENO);
    action();
    dup2(before, STDOUT_FILENO);
    close(before);
    std::string text;
    char piece[4096];
    fcntl(terminal, F_SETFL, O_NONBLOCK);
    for (ssize_t got; (got = read(terminal, piece, sizeof piece)) > 0;) text.append(piece, static_cast<size_t>(got));
    close(slave);
    close(terminal);
    return text;
}

TEST(Progress, AnOpenJobDescriptionSessionIsToldWhatItListensFor) {
    const std::string text = output_of([] {
        Progress progress(ProgressStyle::openjd, "render", 2);
        progress.set(1);
        progress.line("frame 1");
        progress.finish();
    });
    EXPECT_THAT(lines_of(text), ElementsAre("openjd_progress: 0", "openjd_progress: 50", "openjd_status: frame 1",
                                            "openjd_progress: 100"));
}

TEST(Progress, AFileGetsALineForEveryPercentThatChanges) {
    const std::string text = output_of([] {
        Progress progress(ProgressStyle::automatic, "render", 200);
        for (const double done : {1.0, 2.0, 2.5, 3.0, 4.0, 150.0}) progress.set(done);
        progress.finish();
    });
    EXPECT_THAT(lines_of(text), ElementsAre("ALF_PROGRESS 0%", "ALF_PROGRESS 1%", "ALF_PROGRESS 2%", "ALF_PROGRESS 75%",
                                            "ALF_PROGRESS 100%"));
    EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Progress, EveryPercentOfAHundredIsExact) {
    const std::string text = output_of([] {
        Progress progress(ProgressStyle::alf, "render", 100);
        for (int i = 1; i <= 100; ++i) progress.set(i);
    });
    const auto lines = lines_of(text);
    ASSERT_EQ(lines.size(), 101u);
    for (size_t i = 0; i <= 100; ++i) EXPECT_EQ(lines[i], "ALF_PROGRESS " + std::to_string(i) + "%");
}

TEST(Progress, NeverGoesBackNorOutOfRange) {
    const std::string text = output_of([] {
        Progress progress(ProgressStyle::alf, "render", 10);
        for (const double done : {5.0, 3.0, -1.0, std::nan(""), 1e9, 20.0}) progress.set(done);
        progress.finish();
        progress.set(1);
        progress.finish();
    });
    EXPECT_THAT(lines_of(text), ElementsAre("ALF_PROGRESS 0%", "ALF_PROGRESS 50%", "ALF_PROGRESS 100%"));
}

TEST(Progress, AnAbandonedJobNeverClaimsToBeDone) {
    const std::string text = output_of([] {
        Progress progress(ProgressStyle::alf, "render", 10);
        progress.set(9.99);
    });
    EXPECT_THAT(lines_of(text), ElementsAre("ALF_PROGRESS 0%", "ALF_PROGRESS 99%"));
    EXPECT_THAT(terminal_output_of([] { Progress(ProgressStyle::automatic, "render", 10).set(5); }),
                testing::Not(HasSubstr("done")));
}

TEST(Progress, NothingToDoIsDoneWhenFinished) {
    const std::string text = output_of([] { Progress(ProgressStyle::alf, "render", 0).finish(); });
    EXPECT_THAT(lines_of(text), ElementsAre("ALF_PROGRESS 0%", "ALF_PROGRESS 100%"));
}

TEST(Progress, JsonLinesCanBeParsed) {
    const std::string text = output_of([] {
        Progress progress(ProgressStyle::json, "bake \"a\"\n", 100);
        progress.set(42);
        progress.finish();
    });
    const auto lines = lines_of(text);
    ASSERT_EQ(lines.size(), 3u);
    const double expected[] = {0, 0.42, 1};
    for (size_t i = 0; i < 3; ++i) {
        const Json line = parse_json(lines[i], "progress");
        EXPECT_EQ(line.string_or("what", ""), "bake \"a\"\\x0a");
        EXPECT_DOUBLE_EQ(line.number_or("progress", -1), expected[i]);
        EXPECT_GE(line.number_or("elapsed", -1), 0);
        EXPECT_EQ(line.find("left")->kind, i == 0 ? Json::Kind::null : Json::Kind::number);
    }
    EXPECT_EQ(parse_json(lines[2], "progress").number_or("left", -1), 0);
}

TEST(Progress, SkippedUnitsTookNoTimeAndNeedNone) {
    const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(30)); };
    Progress progress(ProgressStyle::silent, "render", 10);
    EXPECT_LT(progress.left(), 0) << "unknown";
    wait();
    const double start = steady_seconds();
    progress.skip(8);
    EXPECT_EQ(progress.share(), 0.8);
    EXPECT_LT(progress.left(), 0) << "still unknown";
    wait();
    progress.set(1);
    EXPECT_EQ(progress.share(), 0.9);
    const double left = progress.left();
    EXPECT_GE(left, 0.03);
    EXPECT_LE(left, steady_seconds() - start);
    progress.skip(5); // more than there are
    EXPECT_EQ(progress.share(), 1);
    EXPECT_EQ(progress.left(), 0);
}

TEST(Progress, NoneIsSilentAndStderrKeepsStdoutFree) {
    testing::internal::CaptureStderr();
    const std::string text = output_of([] {
        Progress silent(ProgressStyle::none, "render", 2);
        silent.set(1);
        silent.finish();
        Progress(ProgressStyle::alf, "render", 2, true).set(1);
    });
    EXPECT_EQ(text, "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "ALF_PROGRESS 0%\nALF_PROGRESS 50%\n");
}

TEST(Progress, LinesAreForPeopleOnStderr) {
    testing::internal::CaptureStderr();
    const std::string text = output_of([] {
        Progress progress(ProgressStyle::alf, "render", 2);
        progress.line("frame 12 done\x1b[2J");
        progress.line(std::string(10000, 'x'));
    });
    const auto lines = lines_of(testing::internal::GetCapturedStderr());
    EXPECT_EQ(text, "ALF_PROGRESS 0%\n");
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0], "frame 12 done\\x1b[2J");
    EXPECT_LE(lines[1].size(), 500u);
}

TEST(Progress, ATerminalGetsOneLineThatIsDrawnOver) {
    testing::internal::CaptureStderr();
    const std::string text = terminal_output_of([] {
        Progress progress(ProgressStyle::automatic, "render", 4);
        progress.set(1);
        std::this_thread::sleep_for(std::chrono::milliseconds(120));
        progress.set(2);
        progress.line("frame 7");
        progress.finish();
    });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "frame 7\n");
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_TRUE(text.ends_with("\n"));
    EXPECT_EQ(text.find("ALF"), std::string::npos);

    // Drawn at 0 %, not at 25 % (too soon), at 50 %, wiped for the line, again at 50 %, and at the end.
    std::vector<std::string> drawn;
    std::istringstream stream(text);
    for (std::string piece; std::getline(stream, piece, '\r');)
        if (piece.find_first_not_of(" \r\n") != std::string::npos) drawn.push_back(piece);
    ASSERT_EQ(drawn.size(), 4u) << text;
    EXPECT_THAT(drawn[0], testing::MatchesRegex("render \\[-{40}\\]   0%  0:00 *"));
    EXPECT_THAT(drawn[1], testing::MatchesRegex("render \\[#{20}-{20}\\]  50%  0:00  0:00 left *"));
    EXPECT_EQ(drawn[2].substr(0, 56), drawn[1].substr(0, 56));
    EXPECT_THAT(drawn[3], testing::MatchesRegex("render \\[#{40}\\] 100%  0:00  done *"));
    for (const std::string& line : drawn) EXPECT_LE(line.size(), 80u);
}

TEST(Progress, ThreadsMayReportTogether) {
    const std::string text = output_of([] {
        Progress progress(ProgressStyle::alf, "render", 4000);
        std::vector<std::thread> threads;
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&, t] {
                for (int i = 0; i <= 1000; ++i) progress.set(4 * i - t);
            });
        for (std::thread& thread : threads) thread.join();
        progress.finish();
    });
    int last = -1;
    for (const std::string& line : lines_of(text)) {
        int percent = -1;
        ASSERT_EQ(std::sscanf(line.c_str(), "ALF_PROGRESS %d%%", &percent), 1) << line;
        EXPECT_GT(percent, last);
        last = percent;
    }
    EXPECT_EQ(last, 100);
}

TEST(Progress, ClosedOutputIsNoReasonToStop) {
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGPIPE, SIG_IGN);
        int ends[2];
        const bool piped = pipe(ends) == 0 && dup2(ends[1], STDOUT_FILENO) >= 0 && close(ends[0]) == 0;
        close(STDERR_FILENO);
        for (const ProgressStyle style : {ProgressStyle::alf, ProgressStyle::bar, ProgressStyle::json}) {
            Progress progress(style, "render", 2);
            progress.set(1);
            progress.line("frame 1");
            progress.finish();
        }
        _exit(piped ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}
}
}
