// Error of multiple scattering from a grid (trace/fluence) against path tracing, measured on pixels of the image before
// it is rendered.
#pragma once
#include "modes/limitation.h"
#include "render/frame/frame.h"

namespace tyndall {
// Whether multiple scattering comes from a grid.
bool takes_fluence(const Mode& mode, const Settings& settings);

// Traces both through the same pixels until their difference is known to half its size, or to be small relative to the
// target `error` (0 = none: only a few rays are traced). `stop` returns true when time is up; with it, fewer tiles are
// used, and a few rays are traced in any case. The same bits at any thread count, unless stopped.
OrdersError orders_error(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                         double error, const FrameOptions& options, const std::function<bool()>& stop = {});

// What a target error leaves for noise and integrator beside another error; none if that is too little.
std::optional<double> remaining_error(const Noise& other, double error);

namespace limitation {
inline constexpr LimitationKind approximate_orders{
    "approximate_orders", "multiple scattering is approximated on a grid: against path tracing, pixels are up to {} % "
                          "off (RMS), the whole image up to {} %"};
}
Limitation limitation_of(const OrdersError& orders);
}
