// Errors of the OpenVDB library as those of this program.
#pragma once
#include "base/error.h"
#include "base/text.h"

#include <exception>
#include <new>
#include <string>

namespace tyndall {
// Converts library exceptions: their messages can be gigabytes long, and running out of memory has its own exit code.
template<class Body> auto with_library_errors(ExitCode code, const std::string& where, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        fail(ExitCode::out_of_memory, where, "does not fit into memory");
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        fail(code, where, "OpenVDB error: " + printable(error.what(), 160));
    }
}
}
