// What a task of a job is told to take.
#include "render/farm/forecast.h"

#include <gtest/gtest.h>

namespace tyndall::test {
TEST(Forecast, PartsShareSamplesAndProcessorsNotTheSetup) {
    FarmJob job;
    job.frames = {1, 2, 3}, job.chunk = 1, job.parts = 1, job.cpus = 0;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 102);
    job.parts = 10;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 12);
    job.cpus = 1;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 42);
    job.chunk = 2;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 84);
    job.chunk = 8;
    EXPECT_DOUBLE_EQ(task_seconds(job, 2, 100, 4), 126) << "no more frames than there are";
}
}
