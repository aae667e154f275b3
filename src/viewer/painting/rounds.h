// Progressive refinement of a still image: rounds of samples, averaged.
#pragma once
#include "measure/chart/reference.h"
#include "render/frame/layers.h"

#include <array>

namespace tyndall {
struct Mode;
struct Prepared;
struct Request;
struct Snapshot;

// The result of a mode's rounds so far. The first is a preview of one sample, which the second replaces.
struct Rounds {
    std::shared_ptr<const Prepared> prepared; // from the snapshot
    Layers layers;
    int samples = 0, rounds = 0;
    double sample_seconds = 0;         // of the last round
    std::vector<int> made;             // samples of each round
    std::array<ColorLayers, 2> halves; // means of alternate rounds, without the first
    std::array<int, 2> half_samples{};

    // Starts over; the layers stay until new ones replace them.
    void forget() { *this = {nullptr, std::move(layers), 0, 0, 0, {}, {}, {}}; }
};

// One round. Its sample positions are the same for any mode's round of this number and size.
struct Round {
    Layers layers;
    FrameStats stats;
};
Round render_round(Rounds& rounds, const Mode& mode, const Request& request, const Settings& settings,
                   const Snapshot& snapshot, int samples, std::atomic<bool>& cancel);

// Adds a round to the mean of all rounds.
void add_round(Round round, const Request& request, Rounds& rounds);

// Number of samples of the next round: that of `like` for as many rounds as it has; else first one, then as many as the
// settings say, which gives the image that tyndall render makes, then about as many as there are already, limited in
// time.
int round_samples(const Rounds& rounds, const Request& request, const Rounds* like = nullptr);
}
