// A line of a path, and what happens on it. Internal to the path tracer.
#pragma once
#include "base/random.h"
#include "modes/path/connect.h"
#include "modes/path/lights.h"
#include "trace/lights/environment.h"
#include "trace/occlusion/occluders.h"
#include "volume/medium.h"

namespace tyndall {
inline constexpr int max_layers = 64;    // BLEND surfaces on one line; the last counts as opaque
inline constexpr int certain_orders = 4; // scatterings before Russian roulette may end a path
// Purposes of random numbers, each with its own sequence.
enum Use : uint32_t {
    use_distance,
    use_free_path,
    use_light,
    use_phase,
    use_soft,
    use_glow,
    use_roulette,
    use_blend,
    use_surface_light,
    use_surface_soft,
    use_surface_glow,
    use_bounce,
    use_emission,
    use_fire,
    use_in_fire,
    use_sky,
    use_sky_distance,
    use_channel
};

// The end of a path: where its next line starts, and its throughput.
struct PathVertex {
    size_t lane = 0;
    Ray ray;
    float skip = 0;      // surfaces nearer than this are ignored
    vec3 throughput{1};  // fraction of light that arrives at the eye along the path
    vec3 shares{1};      // in chromatic fog, the path's pdf in each channel over their mean: MIS weights, times 3
    float pdf = 0;       // solid-angle pdf of the line's direction; 0 at the eye
    float sky_scale = 0; // factor on environment light that the line finds; 0 = it does not look for it
    float peak = 0;      // of the phase function at its start, 1/sr, if the line looks for faces of lights; else 0
    bool in_fog = false; // the path's first event was in fog
    bool ambient = true; // the line finds ambient light
    SampleIndex sample{0, 0};
    uint32_t id = 0;
    int channel = 0; // by whose extinction the path is sampled
};

// The current line of a path.
struct Segment {
    PathVertex vertex;
    Ray rest;                         // from the last BLEND surface on
    float skip = 0, traveled = 0;     // traveled: up to the start of `rest`
    float end = 0;                    // of the current segment, along `rest`
    vec3 transmittance{1};            // of fog and surfaces so far
    vec3 pdfs{1};                     // in chromatic fog, of the path up to its end by channel, times a factor
    int instance = -1, triangle = -1; // surface just passed
    bool unscattered = true;          // the path has not scattered yet
    int order = 0, layer = 0;
    RandomStream random;

    vec2 numbers(Use use) const {
        const uint32_t step = static_cast<uint32_t>(order * max_layers + layer);
        const Sample2 u = sample2(vertex.sample.index, hash(vertex.sample.sequence, step, static_cast<uint32_t>(use)));
        return {u.x, u.y};
    }
    bool lit() const { return max_component(transmittance) > 0; } // whether light on the rest of it arrives
    bool open() const { return unscattered || lit(); }
};

// Extinctions and albedos of all media at a point.
struct FogPoint {
    vec3 position{0};
    std::vector<float> extinction; // 1/m, of each medium
    std::vector<vec3> albedo;      // of media with an albedo field
    float total = 0;
    vec3 channels{1}; // total extinction of each channel, relative to `total`

    vec3 albedo_of(const Optics& optics, size_t m) const { return optics.albedo_field ? albedo[m] : optics.albedo; }

    // Σ albedo p, and Σ p, weighted by each medium's fraction of the extinction; the first by channel.
    vec3 scattered(const Snapshot& snapshot, float cosine) const {
        vec3 sum(0);
        for (size_t m = 0; m < extinction.size(); ++m)
            if (extinction[m] > 0) {
                const Optics& optics = snapshot.media[m].optics;
                sum += albedo_of(optics, m) * optics.channels *
                       (extinction[m] / total * phase_value(optics.phase, cosine));
            }
        return sum;
    }
    float phase_pdf(const Snapshot& snapshot, float cosine) const {
        float sum = 0;
        for (size_t m = 0; m < extinction.size(); ++m)
            if (extinction[m] > 0) sum += extinction[m] / total * phase_value(snapshot.media[m].optics.phase, cosine);
        return sum;
    }
};

// Memory that a thread reuses from batch to batch.
struct PathScratch {
    std::vector<Segment> lines;
    std::vector<PathVertex> vertices;
    std::vector<Connection> connections;
    std::vector<LineLight> lights;
    FogPoint fog;
};

// State of one batch.
struct PathState {
    const PathTracer& tracer;
    const Snapshot& snapshot;
    const RayBatch& batch;
    std::span<Scatter> results;
    PathScratch& scratch;
    int order = 0;
    bool scatters = true; // whether paths may scatter at the end of the current lines

    // Of the channels, which are equal in gray fog.
    float mean(vec3 value) const { return tracer.chromatic ? mean_component(value) : value.x; }
};

// Adds radiance times the path's throughput, without the line's attenuation, as other light or as that of a light of
// the snapshot.
void add_light(const PathState& state, const Segment& line, vec3 radiance, OtherLight light, bool in_fog);
void add_light(const PathState& state, const Segment& line, vec3 radiance, size_t light, bool in_fog);

// PathVertex::shares at the end of the line's walk, by the balance heuristic.
inline vec3 shares_of(const PathState& state, const Segment& line) {
    return state.tracer.chromatic ? line.pdfs / mean_component(line.pdfs) : vec3(1);
}

// Unbiased estimate of the transmittance of fog between two distances of the current segment (ratio tracking).
vec3 line_transmittance(const PathState& state, Segment& line, Interval<float> range);

// Queues a connection that contributes `light` times the path's throughput if nothing is in its way.
void queue(const PathState& state, Segment& line, Connection connection, vec3 light, bool in_fog);

// Whether links limit what an instance's light reaches or which surfaces shadow it.
inline bool is_linked(const Snapshot& snapshot, int instance) {
    return emission_links(snapshot, instance) != ivec2(-1);
}

// Samples a point in emissive fog for a connection.
EmissionSample pick_fire(const PathState& state, const Segment& line);

// Adds environment light from one sampled direction, at a point that scatters `share(direction)`, 1/sr, into the line
// and samples directions itself with the `pdf(direction)`, 1/sr.
template<class Share, class Pdf>
void gather_sky(const PathState& state, Segment& line, vec3 point, vec3 face_normal, float scale, bool in_fog,
                const Share& share, const Pdf& pdf) {
    const EnvironmentSample sky = sample_environment(*state.snapshot.environment, line.numbers(use_sky));
    const float own = state.tracer.finds_sky ? pdf(sky.direction) : 0;
    if (!(sky.pdf > 0)) return;
    Connection connection = connection_to_sky(*state.snapshot.environment, point, sky.direction);
    connection.face_normal = face_normal;
    queue(state, line, connection, share(sky.direction) * sky.radiance * (scale / (sky.pdf + own)), in_fog);
}

// A scattering event: the path's next line, its weight, and values for its PathVertex.
struct ScatterEvent {
    Ray ray;
    vec3 share{1};
    float pdf = 0, sky_scale = 0, peak = 0;
    bool ambient = true;
};

// Starts the path's next line, unless Russian roulette ends the path.
void scatter(const PathState& state, const Segment& line, const ScatterEvent& event, bool in_fog);

// Adds light from the fog of the current segment, then tests whether the path collides there and scatters.
void follow_fog(const PathState& state, Segment& line);

// Handles the surface at the end of the current segment: adds its emission and the direct light it reflects, may
// scatter the path there, and moves the line on to what lies behind.
void hit_surface(const PathState& state, Segment& line, const SurfacePoint& surface, int instance, int triangle);
}
