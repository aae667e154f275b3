// Checks that many tests make, and the texts they make them on.
#pragma once
#include "base/error.h"
#include "base/math.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <string_view>

namespace tyndall {
// The Error that `action` throws; its code is `ok` when it throws none.
Error error_of(const std::function<void()>& action);

// Its message, which must be one short line and the Error carry `code`; empty (and a failure) when there is none.
std::string error_message(ExitCode code, const std::function<void()>& action);

// The text with the first `what` replaced, which must be in it.
std::string replaced(std::string text, std::string_view what, std::string_view by);

template<int N> void expect_near(glm::vec<N, float> a, glm::vec<N, float> b, float tolerance = 1e-6f) {
    for (int i = 0; i < N; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}
}
