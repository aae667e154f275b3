// Embree's device: one per process, its instruction set pinned so that hits do not depend on the machine.
#include "base/error.h"
#include "trace/occlusion/scene.h"

#include <mutex>
#include <string>
#include <utility>

namespace tyndall {
namespace {
struct DeviceState {
    std::mutex mutex;
    std::string isa = "avx2";
    RTCDevice device = nullptr;
    bool sixteen = false;
    RTCError error = RTC_ERROR_NONE;
    std::string message;
};

DeviceState& state() {
    static DeviceState the_state;
    return the_state;
}

void remember_error(void*, RTCError code, const char* message) {
    DeviceState& s = state();
    const std::lock_guard lock(s.mutex);
    if (s.error != RTC_ERROR_NONE) return;
    s.error = code;
    s.message = message ? message : "";
}

[[noreturn]] void fail_with(RTCError code, const std::string& message) {
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        fail(ExitCode::out_of_memory, "ray tracing", "not enough memory for the scene's triangles");
    fail(ExitCode::internal, "ray tracing", "Embree error " + std::to_string(code) + ": " + message);
}
}

void set_embree_isa(std::string_view isa) {
    if (isa == "auto") isa = "avx2";
    if (isa != "avx2" && isa != "avx512")
        fail(ExitCode::usage, "instruction set", std::string(isa) + " is not one of auto, avx2, avx512");
    if (isa == "avx512" && !__builtin_cpu_supports("avx512dq"))
        fail(ExitCode::usage, "instruction set", "this machine does not support AVX-512");
    DeviceState& s = state();
    const std::lock_guard lock(s.mutex);
    if (s.device && isa != s.isa)
        fail(ExitCode::internal, "instruction set", "set to " + std::string(isa) + " after the ray tracer started");
    s.isa = isa;
}

// Leaves thread count and affinity alone: Embree's `threads` would limit the whole process.
RTCDevice embree_device() {
    DeviceState& s = state();
    const std::lock_guard lock(s.mutex);
    if (s.device) return s.device;
    s.device = rtcNewDevice(("isa=" + s.isa + ",threads=0,set_affinity=0,verbose=0").c_str());
    if (!s.device) fail_with(rtcGetDeviceError(nullptr), "cannot create a device for " + s.isa);
    rtcSetDeviceErrorFunction(s.device, remember_error, nullptr);
    s.sixteen = rtcGetDeviceProperty(s.device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    return s.device;
}

bool traces_sixteen() {
    static const bool sixteen = (embree_device(), state().sixteen);
    return sixteen;
}

void check_embree() {
    DeviceState& s = state();
    const std::lock_guard lock(s.mutex);
    const RTCError code = std::exchange(s.error, RTC_ERROR_NONE);
    if (code != RTC_ERROR_NONE) fail_with(code, std::exchange(s.message, {}));
}
}
