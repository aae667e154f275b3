// A job for a farm: the frames of a scene in parts, and the folder that holds all of it.
//
//   job.json               what was submitted
//   plan.json              the plan, or plans/plan.FRAME.json where each frame has its own
//   parts/NAME.####.part-i-of-N.exr
//   frames/NAME.####.exr   merged
//   logs/                  of the engine
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace tyndall {
struct FarmJob {
    std::filesystem::path folder; // absolute
    std::string engine;           // slurm or openjd
    std::string program, scene;   // absolute
    std::string name;             // of the frame files
    std::vector<int> frames;      // ascending
    int parts = 1, chunk = 1;     // parts per frame, frames per task
    int cpus = 0;                 // per task; 0 = left to the engine
    int memory = 0, minutes = 0;  // limits per task, memory in MiB; 0 = from a forecast
    bool plan_for_each_frame = false;
    std::vector<std::string> plan_options; // of tyndall plan, except scene, frames and file
    bool remove_parts = false;             // once merged
};

// The folder as files name it: absolute, without a trailing slash.
std::filesystem::path job_folder(const std::filesystem::path& folder);

// A job name from a scene's, in characters that shells, engines and frame patterns leave unchanged.
std::string job_name_of(const std::filesystem::path& scene);

// Whether tasks of one frame share work that is prepared once.
inline bool shares_work(const FarmJob& job) { return job.parts > 1; }

// Throws Error (unwritable).
void save_job(const FarmJob& job);
// Throws Error (unreadable, refused).
FarmJob load_job(const std::filesystem::path& folder);
std::string job_text(const FarmJob& job); // the content of job.json

// Names within the folder; patterns have #### for the frame.
std::string plan_name(const FarmJob& job, int frame);
std::string part_pattern(const FarmJob& job);
std::string frame_pattern(const FarmJob& job);

// The frames of each task, in order.
std::vector<std::vector<int>> chunks_of(const FarmJob& job);
}
