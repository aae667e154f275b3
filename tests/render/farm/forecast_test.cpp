// What a task of a job is told to take.
#include "render/farm/forecast.h"

#include <gtest/gtest.h>

namespace tyndall::test {
TEST(Forecast, PartsShareTheSamplesAndNotTheSetup) {
    FarmJob job;
    job.frames = {1, 2, 3}, job.chunk = 1, job.parts = 1, job.cpus = 4;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 102);
    job.parts = 10;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 12);
    job.chunk = 2;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 24);
    job.chunk = 8;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 36) << "no more frames than there are";
}

TEST(Forecast, FewerProcessorsSlowDownAllOfATaskAndMoreOnlyMakeSamplesFaster) {
    FarmJob job;
    job.frames = {1}, job.cpus = 1;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 408);
    job.cpus = 8;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 52);
}

TEST(Forecast, SlurmGivesOneProcessorToATaskThatAsksForNone) {
    FarmJob job;
    job.frames = {1}, job.cpus = 0, job.engine = "slurm";
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 408);
    job.engine = "openjd"; // a whole worker, taken to be like this machine
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 102);
}
}
