// Rounds of samples, averaged: how a still picture becomes better while it is looked at.
#pragma once
#include "measure/chart/reference.h"
#include "render/frame/layers.h"

#include <array>

namespace tyndall {
struct Mode;
struct Prepared;
struct Request;
struct Snapshot;

// What the rounds of a mode have come to. The first one is a look of one sample, which the second replaces.
struct Rounds {
    std::shared_ptr<const Prepared> prepared; // from the snapshot
    Layers layers;
    int samples = 0, rounds = 0;
    double sample_seconds = 0;         // of the last round
    std::vector<int> made;             // samples of each round
    std::array<ColorLayers, 2> halves; // of all but the first round, in turns
    std::array<int, 2> half_samples{};

    // Begins anew; the layers stay until others are there.
    void forget() { *this = {nullptr, std::move(layers), 0, 0, 0, {}, {}, {}}; }
};

// One round, whose samples lie where those of any mode's round of this number and size do.
struct Round {
    Layers layers;
    FrameStats stats;
};
Round render_round(Rounds& rounds, const Mode& mode, const Request& request, const Settings& settings,
                   const Snapshot& snapshot, int samples, std::atomic<bool>& cancel);

// Into the mean of all rounds.
void add_round(Round round, const Request& request, Rounds& rounds);

// Samples of the next round: those of `like`, as far as that has got; else first one, then as many as the settings say,
// which makes the picture that tyndall render makes, then about as many as there are, soon over.
int round_samples(const Rounds& rounds, const Request& request, const Rounds* like = nullptr);
}
