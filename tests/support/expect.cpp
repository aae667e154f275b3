#include "support/expect.h"

namespace tyndall {
Error error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error;
    }
    return Error(ExitCode::ok, "", "");
}

std::string error_message(ExitCode code, const std::function<void()>& action) {
    const Error error = error_of(action);
    const std::string text = error.what();
    EXPECT_NE(static_cast<int>(error.code), static_cast<int>(ExitCode::ok)) << "nothing was refused";
    EXPECT_EQ(static_cast<int>(error.code), static_cast<int>(code)) << text;
    EXPECT_LE(text.size(), 500u);
    EXPECT_EQ(text.find('\n'), text.npos);
    return error.code == ExitCode::ok ? "" : text;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
    const size_t place = text.find(what);
    EXPECT_NE(place, text.npos) << what << " in " << text;
    return place == text.npos ? text : text.replace(place, what.size(), by);
}
}
