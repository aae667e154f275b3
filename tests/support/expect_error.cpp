#include "support/expect_error.h"

#include <gtest/gtest.h>

namespace tyndall {
std::string error_text(ExitCode code, const std::function<void()>& action) {
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
