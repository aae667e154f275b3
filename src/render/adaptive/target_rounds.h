// How much work comes next on the way to an image with a given error. At first all pixels take the same number of
// samples; if that shows that some need many more than others, the image starts over with as many as each needs, and
// once more if that shows what was missed.
#pragma once
#include "base/random.h"
#include "modes/mode.h"
#include "render/adaptive/allotment.h"
#include "render/adaptive/goal.h"
#include "render/adaptive/to_target.h"

namespace tyndall {
double pixel_count(const View& view); // in the crop window

// Effective number of pixels from which on few samples of each show where noise is, and how much.
inline constexpr double many_pixels = 256;

// The rounds of one image. Work is counted in samples per pixel; after an allotment, in multiples of it.
struct TargetRounds {
    const Mode& mode;
    View view; // as requested; samples go where variance is measured, not by rule to lamps and edges
    Goal& goal;
    double start = 0;             // when the goal's time began
    bool is_timed = false;        // by the goal as asked, not by a forecast
    std::optional<Choice> choice; // if anything was measured beforehand
    std::optional<Allotment> allotment{};
    double work_seconds = 0; // per unit of work: from the last round, or as measured beforehand
    double first_part = 1;   // share of an allotment to render first
    double done = 0, expected = max_target_samples;
    int freedom = 0;          // degrees of freedom of the noise estimate so far
    int sequence = 0;         // round that an allotment began with: its parts may continue the sequences of that round
    double check_seconds = 0; // predicted for the check of the image

    double left() const { return goal.seconds - check_seconds - (goal.clock() - start); }
    int max_batches() const { return is_unbiased(mode) || view.batches > 1 ? noise_batches : 2; }
    int fewest() const { return view.batches > 1 ? 2 : 1; }
    // Samples are allotted in multiples of this number.
    int unit() const { return view.batches > 1 ? 8 : is_unbiased(mode) ? 4 : 2; }
    // Whether parts of an allotment continue the same two batches, in which noise falls fastest: only if many pixels
    // together show the noise from the difference of two.
    bool continues() const {
        return allotment && view.batches == 1 && !is_unbiased(mode) && allotment->pixels >= many_pixels;
    }
    double power() const { return choice ? std::clamp(choice->power, 1.0, 1.5) : 1; }
    double power_of_parts() const { return continues() ? power() : 1; } // independent ones add up as 1 / n

    Image<float> samples_taken(const Layers& layers) const {
        return allotment ? samples_in(*allotment, done, unit(), continues()) : uniform_samples(layers, done);
    }

    // Whether the integrator is checked after the first round: a technique that was preferred to the main one for its
    // speed loses all of it if it misses the target.
    bool checks_early() const { return choice && !is_timed && choice->from_contest; }

    double noise_target() const { return choice ? tyndall::noise_target(*choice, goal.error) : goal.error; }

    // The view of a round of `work`, which is rounded to whole samples; `part` is the part of an allotment to render,
    // if any.
    View round_view(double& work, int round, const AllottedPart* part) const {
        View result = view;
        const int numbers = part && part->before ? sequence : round;
        if (numbers > 0) result.seed = hash(view.seed, static_cast<uint32_t>(numbers));
        result.batches = part ? unit() : std::min(max_batches(), static_cast<int>(work));
        result.pixel_samples = part ? unit() : static_cast<int>(work) / result.batches * result.batches;
        if (part)
            result.allotted = part->factors, result.before = part->before;
        else
            work = result.pixel_samples;
        return result;
    }
};

// Whether the integrator's error bound alone reaches the target.
bool is_out_of_reach(const Choice& choice, double error);

// Samples per pixel of the first round: the view's if nothing was measured; otherwise a small part of what is likely to
// be needed, which shows which pixels need it.
int first_round(TargetRounds& rounds);

// Allots samples by what the scout shows, or else predicts how many all pixels need. Returns the work of the first
// round.
double begin_with_scout(TargetRounds& rounds, FrameStats& stats);

// Starts over with a new allotment if the rounds so far show that it saves work; returns whether it does.
bool begin_allotment(TargetRounds& rounds, const Layers& layers, FrameStats& stats);

// Work of the next round: large enough that few rounds suffice, but no more than all before it; 0 when time is up.
double next_round(TargetRounds& rounds, const FrameStats& stats);

// Updates the error statistics after a round; true if the error is small enough, or as small as the integrator allows.
bool judge(TargetRounds& rounds, const Layers& result, FrameStats& stats);

// Predicted seconds to the goal if `next` is the next work: an allotment may be enough after its first part, or be
// started over. Noise falls fastest at first: the power measured there holds for about half of the way (in logarithms),
// and the rest falls as 1 / n. The rounds must have a choice.
double seconds_ahead(const TargetRounds& rounds, double next);
}
