// Checks of what a user is told when something is refused.
#pragma once
#include "base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace tyndall {
// The message of the Error that `action` throws, which must carry `code`; empty (and a failure) when it throws none.
template<class Action> std::string error_text(ExitCode code, Action action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(static_cast<int>(error.code), static_cast<int>(code)) << error.what();
        EXPECT_LE(std::string(error.what()).size(), 500u);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
}
}
