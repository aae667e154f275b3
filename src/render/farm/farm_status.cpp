#include "render/farm/farm_status.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/farm/commands.h"
#include "render/image/exr_glance.h"
#include "render/parts/part_file.h"
#include "render/sequence/job.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace tyndall {
namespace {
constexpr size_t waiting_threads = 16;

// The expected header. Without a plan hash a finished frame may be of any plan, since its own is not needed any more.
struct Expected {
    std::string frame, part, plan_hash;
};

std::string disagreement(const ExrSummary& summary, const Expected& expected) {
    if (summary.frame != expected.frame) return "belongs to another frame";
    if (summary.partial) return "was merged while parts were missing";
    if (summary.part != expected.part)
        return expected.part.empty() ? "is a part, not a frame" : "is not the expected part (number or count differs)";
    const bool any_plan = expected.part.empty() && expected.plan_hash.empty();
    if (summary.plan_hash != expected.plan_hash && !any_plan) return "was made from another plan";
    return {};
}

// Why the file cannot be used; none if it can, "" if it does not exist.
std::optional<std::string> problem_of(const std::filesystem::path& file, const Expected& expected, bool verify) {
    try {
        const std::optional<ExrSummary> summary = exr_summary(file);
        if (!summary) return "";
        if (const std::string why = disagreement(*summary, expected); !why.empty()) return why;
        if (verify && !expected.part.empty()) read_part(file);
        if (verify && expected.part.empty() && !read_exr(file).is_unchanged)
            return "damaged: its contents do not match its checksum";
    } catch (const Error& error) {
        const std::string what = error.what(), place = file.string() + ": ";
        return what.starts_with(place) ? what.substr(place.size()) : what;
    }
    return {};
}

std::string hash_of_plan(const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::exists(file, ignored) ? content_hash(read_file(file)) : std::string();
}

// The status of one frame; adds its files that cannot be used to `suspects`.
FarmFrame frame_status(const FarmJob& job, int frame, const std::string& shared_plan, bool verify,
                       std::vector<SuspectFile>& suspects) {
    FarmFrame result{frame, true, false, {}};
    Expected expected{std::to_string(frame), {}, shared_plan};
    const auto usable = [&](const std::string& name) {
        const std::optional<std::string> problem = problem_of(job.folder / name, expected, verify);
        if (problem && !problem->empty()) suspects.push_back({name, *problem});
        return !problem;
    };
    if (job.plan_for_each_frame) expected.plan_hash = hash_of_plan(job.folder / plan_name(job, frame));
    result.planned = !expected.plan_hash.empty();
    result.finished = usable(frame_name(frame_pattern(job), frame));
    if (result.finished) return result;

    Grouping grouping;
    grouping.parts = job.parts;
    const std::string pattern = frame_name(part_pattern(job), frame);
    for (grouping.part = 1; grouping.part <= job.parts; ++grouping.part) {
        expected.part = formatted("%d/%d", grouping.part, job.parts);
        if (!usable(part_name(pattern, grouping))) result.missing.push_back(grouping.part);
    }
    return result;
}

// Counts the temporary files and checkpoints next to plans, parts and frames.
void count_others(const FarmJob& job, FarmStatus& status) {
    for (const char* folder : {"plans", "parts", "frames"}) {
        std::error_code error;
        for (std::filesystem::directory_iterator entry(job.folder / folder, error), end; !error && entry != end;
             entry.increment(error)) {
            const std::string name = entry->path().filename().string();
            status.temporaries += name.starts_with('.') && name.ends_with(".tmp");
            status.checkpoints += name.ends_with(".checkpoint");
        }
    }
}

// Calls body(i) for each i below count, on many more threads than processors, since they mostly wait for files.
// Rethrows an exception of one of them.
void while_waiting(size_t count, const std::function<void(size_t)>& body) {
    std::atomic<size_t> next{0};
    std::exception_ptr problem;
    std::mutex mutex;
    const auto work = [&] {
        try {
            for (size_t i; (i = next++) < count;) body(i);
        } catch (...) {
            const std::lock_guard lock(mutex);
            problem = std::current_exception();
            next = count;
        }
    };
    {
        std::vector<std::jthread> threads;
        for (size_t i = 0; i < std::min<size_t>(waiting_threads, count); ++i) threads.emplace_back(work);
    }
    if (problem) std::rethrow_exception(problem);
}

std::string command_text(const FarmJob& job, const CommandArgs& words) {
    std::string text = quoted_for_shell(job.program);
    for (const std::string& word : words) text += " " + quoted_for_shell(word);
    return text;
}
}

FarmStatus job_status(const FarmJob& job, bool verify, const std::atomic<bool>& cancel) {
    FarmStatus status;
    const std::string shared_plan =
        job.plan_for_each_frame ? std::string() : content_hash(read_file(job.folder / "plan.json"));
    status.frames.resize(job.frames.size());
    std::vector<std::vector<SuspectFile>> suspects(job.frames.size());
    const auto look = [&](size_t i) {
        if (!cancel) status.frames[i] = frame_status(job, job.frames[i], shared_plan, verify, suspects[i]);
    };
    if (verify)
        parallel_for(static_cast<int64_t>(job.frames.size()), [&](int64_t i) { look(static_cast<size_t>(i)); });
    else
        while_waiting(job.frames.size(), look);
    for (std::vector<SuspectFile>& some : suspects) std::ranges::move(some, std::back_inserter(status.suspects));
    count_others(job, status);
    return status;
}

std::vector<int> missing_tasks(const FarmJob& job, const FarmStatus& status, const std::string& step) {
    std::vector<int> tasks;
    for (size_t i = 0; i < status.frames.size(); ++i) {
        const FarmFrame& frame = status.frames[i];
        const int chunk = static_cast<int>(i) / job.chunk;
        if (step == "plan" && !frame.planned && !frame.finished) tasks.push_back(chunk);
        if (step == "prepare" && !frame.missing.empty()) tasks.push_back(chunk);
        if (step == "merge" && !frame.finished) tasks.push_back(chunk);
        if (step == "parts")
            for (const int part : frame.missing) tasks.push_back(chunk * job.parts + part - 1);
    }
    std::ranges::sort(tasks);
    tasks.erase(std::ranges::unique(tasks).begin(), tasks.end());
    return tasks;
}

std::vector<std::string> missing_commands(const FarmJob& job, const FarmStatus& status) {
    std::vector<std::string> commands;
    CommandVars vars{job.folder.string() + "/", job.scene, {}, {}};
    // Frames that share a plan go together.
    const auto add = [&](const std::vector<int>& frames, const auto& words) {
        std::vector<std::string> ranges;
        if (job.plan_for_each_frame)
            for (const int frame : frames) ranges.push_back(std::to_string(frame));
        else if (!frames.empty())
            ranges.push_back(format_frames(frames));
        for (const std::string& range : ranges) {
            vars.frames = range;
            commands.push_back(command_text(job, words(job, vars)));
        }
    };
    const auto frames_where = [&](const auto& is_meant) {
        std::vector<int> frames;
        for (const FarmFrame& frame : status.frames)
            if (!frame.finished && is_meant(frame)) frames.push_back(frame.frame);
        return frames;
    };
    if (job.plan_for_each_frame) add(frames_where([](const FarmFrame& frame) { return !frame.planned; }), plan_args);
    for (int part = 1; part <= job.parts; ++part) {
        vars.part = std::to_string(part);
        add(frames_where([&](const FarmFrame& frame) { return std::ranges::count(frame.missing, part) > 0; }),
            render_args);
    }
    add(frames_where([](const FarmFrame&) { return true; }), merge_args);
    return commands;
}
}
