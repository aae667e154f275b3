#include "base/io/progress.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/json/json.h"
#include "base/text.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tyndall {
namespace {
// 1:05:09, 2:07 or 0:09
std::string clock_text(double seconds) {
    const long long whole = static_cast<long long>(std::min(std::max(seconds, 0.0), 3.6e8) + 0.5);
    if (whole >= 3600) return formatted("%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
    return formatted("%lld:%02lld", whole / 60, whole % 60);
}

size_t terminal_width(int descriptor) {
    winsize size{};
    return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col >= 20 ? size.ws_col : 80;
}

// "render [######------]  50%  0:10  0:10 left", never wider than the terminal.
std::string bar_text(const std::string& what, double fraction, double elapsed, double left, size_t width) {
    std::string right =
        formatted(" %3d%%  %s  ", static_cast<int>(100 * fraction + 1e-9), clock_text(elapsed).c_str()) +
        (fraction >= 1 ? "done"
         : left >= 0   ? clock_text(left) + " left"
                       : "");
    const size_t taken = what.size() + right.size() + 4;
    const size_t cells = width > taken + 10 ? std::min<size_t>(width - taken, 40) : 0;
    const size_t full = static_cast<size_t>(fraction * static_cast<double>(cells));
    std::string text = what;
    if (cells) text += " [" + std::string(full, '#') + std::string(cells - full, '-') + "]";
    return (text + right).substr(0, width - 1);
}
}

// Failed writes of progress (a closed pipe) must not stop the work, so their results are ignored.

Progress::Progress(ProgressStyle style, std::string_view what, double total, bool to_stderr)
    : style_(style), what_(printable(what, 60)), total_(total), to_stderr_(to_stderr) {
    if (style_ == ProgressStyle::automatic) {
        to_stderr_ = to_stderr_ || !isatty(STDOUT_FILENO);
        style_ = isatty(to_stderr_ ? STDERR_FILENO : STDOUT_FILENO) ? ProgressStyle::bar : ProgressStyle::alf;
        if (style_ == ProgressStyle::alf) to_stderr_ = to_stderr;
    }
    start_ = work_start_ = last_print_ = steady_seconds();
    print(false);
}

Progress::~Progress() {
    if (!finished_ && style_ == ProgressStyle::bar) {
        std::FILE* stream = to_stderr_ ? stderr : stdout;
        std::fputs("\n", stream);
        std::fflush(stream);
    }
}

void Progress::set(double done) {
    const std::lock_guard lock(mutex_);
    if (finished_ || !(done > done_)) return; // also rejects NaN
    done_ = std::min(done, total_ - skipped_);
    print(false);
}

void Progress::skip(double units) {
    const std::lock_guard lock(mutex_);
    if (finished_) return;
    skipped_ = std::min(skipped_ + units, total_ - done_);
    if (done_ == 0) work_start_ = steady_seconds(); // looking for what to skip is no work
    print(false);
}

double Progress::share() const {
    const std::lock_guard lock(mutex_);
    return total_ > 0 ? (done_ + skipped_) / total_ : finished_ ? 1 : 0;
}

double Progress::left() const {
    const std::lock_guard lock(mutex_);
    return unlocked_left();
}

double Progress::unlocked_left() const {
    const double rest = total_ - skipped_ - done_;
    if (rest <= 0) return 0;
    return done_ > 0 ? (steady_seconds() - work_start_) * rest / done_ : -1;
}

void Progress::line(std::string_view text) {
    if (style_ == ProgressStyle::silent) return;
    const std::lock_guard lock(mutex_);
    std::FILE* stream = to_stderr_ ? stderr : stdout;
    const bool drawn = style_ == ProgressStyle::bar && !finished_;
    if (drawn) std::fprintf(stream, "\r%*s\r", static_cast<int>(last_length_), "");
    std::fflush(stream);
    std::fprintf(stderr, "%s\n", printable(text, 480).c_str());
    std::fflush(stderr);
    if (style_ == ProgressStyle::openjd) {
        std::fprintf(stream, "openjd_status: %s\n", printable(text, 480).c_str());
        std::fflush(stream);
    }
    if (drawn) print(true);
}

void Progress::finish() {
    const std::lock_guard lock(mutex_);
    if (finished_) return;
    done_ = total_ - skipped_;
    print(true);
    finished_ = true;
    if (style_ != ProgressStyle::bar) return;
    std::FILE* stream = to_stderr_ ? stderr : stdout;
    std::fputs("\n", stream);
    std::fflush(stream);
}

void Progress::print(bool last) {
    if (style_ == ProgressStyle::none || style_ == ProgressStyle::silent) return;
    const double now = steady_seconds();
    const double elapsed = now - start_, since = now - last_print_;
    const double done = done_ + skipped_, left = unlocked_left();
    const double fraction = total_ > 0 ? done / total_ : last ? 1.0 : 0.0;
    const int percent = total_ > 0 ? static_cast<int>(100 * done / total_ + 1e-9) : last ? 100 : 0;

    // A bar updates at most ten times a second; lines are printed at every percent, and every minute as a heartbeat.
    const bool bar = style_ == ProgressStyle::bar;
    if (last_percent_ >= 0 && (bar ? since < 0.1 && !last : percent == last_percent_ && since < 60)) return;
    last_percent_ = percent;
    last_print_ = now;

    std::FILE* stream = to_stderr_ ? stderr : stdout;
    if (bar) {
        const std::string text = bar_text(what_, fraction, elapsed, left, terminal_width(fileno(stream)));
        std::fprintf(stream, "\r%-*s", static_cast<int>(last_length_), text.c_str());
        last_length_ = text.size();
    } else if (style_ == ProgressStyle::json) {
        std::fprintf(stream, "{\"what\":%s,\"progress\":%.4f,\"elapsed\":%.1f,\"left\":%s}\n",
                     quote_json(what_).c_str(), fraction, elapsed,
                     left >= 0 ? formatted("%.1f", left).c_str() : "null");
    } else if (style_ == ProgressStyle::openjd) {
        std::fprintf(stream, "openjd_progress: %d\n", percent);
    } else {
        std::fprintf(stream, "ALF_PROGRESS %d%%\n", percent);
    }
    std::fflush(stream);
}
}
