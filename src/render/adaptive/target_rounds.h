// How much work comes next on the way to a picture that is as right as wanted. First all pixels take equally many
// samples; where that shows that some need many more than others, the picture is begun anew with as many as each needs,
// and once more where that shows what was missed.
#pragma once
#include "base/random.h"
#include "modes/mode.h"
#include "render/adaptive/allotment.h"
#include "render/adaptive/goal.h"
#include "render/adaptive/to_target.h"

namespace tyndall {
double pixel_count(const View& view); // of what is rendered of it

// The rounds of one picture. Work is counted in samples of all pixels; then in allotments.
struct TargetRounds {
    const Mode& mode;
    View view; // as asked for; what spreads most is measured, not guessed from lamps and edges
    Goal& goal;
    double start = 0;             // of the goal's time
    std::optional<Choice> choice; // where anything was measured beforehand
    std::optional<Allotment> allotment{};
    double work_seconds = 0; // of a unit of work: by the last round, or by what was measured
    double first_part = 1;   // of an allotment
    double done = 0, expected = max_target_samples;
    int freedom = 0;          // differences between batches so far
    int sequence = 0;         // the round that an allotment began with, whose sequences its parts may go on in
    double check_seconds = 0; // that the check of the picture will take

    double left() const { return goal.seconds - check_seconds - (goal.clock() - start); }
    int max_batches() const { return error_is_noise(mode) || view.batches > 1 ? noise_batches : 2; }
    int fewest() const { return view.batches > 1 ? 2 : 1; }
    // Samples that are allotted at once.
    int unit() const { return view.batches > 1 ? 8 : error_is_noise(mode) ? 4 : 2; }
    // Parts of an allotment go on in the same two batches, which noise falls fastest in, where many pixels together
    // tell how far these are apart.
    bool goes_on() const {
        constexpr double many_pixels = 256;
        return allotment && view.batches == 1 && !error_is_noise(mode) && allotment->pixels >= many_pixels;
    }
    double power() const { return choice ? std::clamp(choice->power, 1.0, 1.5) : 1; }
    double power_of_parts() const { return goes_on() ? power() : 1; } // independent ones add up as 1 / n

    Image<float> samples_taken(const Layers& layers) const {
        return allotment ? samples_in(*allotment, done, unit(), goes_on()) : samples_alike(layers, done);
    }

    double noise_target() const { return choice ? tyndall::noise_target(*choice, goal.error) : goal.error; }

    // The view of so much work, and the work it is. What is allotted may come in parts.
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

// Whether the integrator alone may be as wrong as is allowed.
bool is_out_of_reach(const Choice& choice, double error);

// Samples of the first round. Where nothing is known, as the view asks; otherwise a small part of what is likely to be
// needed: it shows which pixels need it.
int first_round(TargetRounds& rounds);

// Begins with what the scout shows, which counts where it is by the candidate chosen. The work that comes next; 0 when
// it is enough.
double begin_with_scout(TargetRounds& rounds, Layers& result, FrameStats& stats);

// Whether samples are better spread by what the rounds so far showed. Then they are, from nothing.
bool begin_allotment(TargetRounds& rounds, const Layers& layers, FrameStats& stats);

// Rounds stay large enough for a few to do, and no round wastes more than all before it; 0 when time is up.
double next_round(TargetRounds& rounds, const FrameStats& stats);

// Sets what is known of the error after each round; true when it is small enough, or as small as the integrator lets it
// become.
bool judge(TargetRounds& rounds, const Layers& result, FrameStats& stats);

// What a goal is likely to take from here, when so much work comes next: an allotment may be enough after its first
// part, or be begun anew. Noise falls fastest at first: the power measured there holds for about half of the way, in
// logarithms, and the rest falls as 1 / n. The rounds must have a choice.
double seconds_ahead(const TargetRounds& rounds, double next);
}
