// How far multiple scattering from a grid (trace/fluence) is from path tracing: measured on pixels of the image before
// it is rendered.
#pragma once
#include "modes/limitation.h"
#include "render/frame/frame.h"

namespace tyndall {
// Whether light of several orders comes from a grid.
bool takes_fluence(const Mode& mode, const Settings& settings);

// Both are followed through the same pixels until what differs is known to half its size, or to be small beside the
// `error` asked for (0 = none is, and no more than a few rays are followed). `stop` says when time is up: then there
// are few tiles, which a few rays are followed to in any case. The same bits at any thread count, unless stopped.
OrdersError orders_error(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                         double error, const FrameOptions& options, const std::function<bool()>& stop = {});

// What an error asked for leaves to noise and integrator beside another part of it; none where that is too little.
std::optional<double> error_beside(const Noise& other, double error);

namespace limitation {
inline constexpr LimitationKind approximate_orders{
    "approximate_orders", "multiple scattering is approximated on a grid: against path tracing, pixels are up to {} % "
                          "off (RMS), the whole image {} %"};
}
Limitation limitation_of(const OrdersError& orders);
}
