// Progress of long work on stdout: a bar with the remaining time on a terminal, otherwise ALF_PROGRESS lines for render
// farms. If only stderr is a terminal, as with "> report.txt", the bar goes there. The openjd style prints the action
// messages of Open Job Description: openjd_progress, and openjd_status for human-readable lines.
#pragma once
#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>

namespace tyndall {
enum class ProgressStyle { automatic, alf, openjd, json, bar, none, silent }; // silent: omits line() output too

// Thread-safe. `to_stderr` keeps stdout free for machine-readable reports.
class Progress {
public:
    Progress(ProgressStyle style, std::string_view what, double total, bool to_stderr = false);
    ~Progress();
    void set(double done);            // without skipped units, absolute; a smaller value than before is ignored
    void skip(double units);          // of the total: they took no time and say nothing of the time left
    double share() const;             // done or skipped, as a fraction of the total
    double left() const;              // seconds of work; negative = unknown
    void line(std::string_view text); // prints a line (a frame finished) without breaking the bar
    void finish();

private:
    void print(bool last);
    double unlocked_left() const;
    mutable std::mutex mutex_;
    ProgressStyle style_;
    std::string what_;
    double total_, done_ = 0, skipped_ = 0;
    bool to_stderr_, finished_ = false;
    int last_percent_ = -1;
    size_t last_length_ = 0;
    double start_ = 0, work_start_ = 0, last_print_ = 0;
};
}
