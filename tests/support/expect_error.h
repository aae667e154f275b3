// Checks of what a user is told when something is refused.
#pragma once
#include "base/error.h"

#include <functional>
#include <string>

namespace tyndall {
// The message of the Error that `action` throws, which must carry `code`; empty (and a failure) when it throws none.
std::string error_text(ExitCode code, const std::function<void()>& action);
}
