// The stability suite has to notice: modes broken on purpose, each caught by a case that the mode itself passes.
#include "integrate/ray_batch.h"
#include "measure/stress/stress.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include "base/parallel.h"
#include "modes/fog_buffer.h"
#include "modes/history.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
using Prepare = decltype(Mode::prepare);

Mode broken(std::string_view name, Prepare prepare) {
    Mode mode = find_mode(name);
    mode.prepare = prepare;
    return mode;
}

Verdict verdict_of(std::string_view id, const Mode& mode) {
    const StressCase& stress = *std::ranges::find(stress_cases(), id, &StressCase::id);
    const std::vector<StressResult> results = run_stress(stress, {&mode, 1});
    EXPECT_EQ(results.size(), 1u) << id << " does not take " << mode.name;
    return results.empty() ? Verdict::holds : results[0].verdict();
}

void expect_caught(std::string_view id, const Mode& mode, Verdict unbroken = Verdict::holds) {
    EXPECT_EQ(verdict_of(id, find_mode(mode.name)), unbroken) << "unbroken";
    EXPECT_EQ(verdict_of(id, mode), Verdict::fails);
}

// A mode whose results are changed afterwards.
template<class Change> ScatterFunction changed(ScatterFunction scatter, Change change) {
    return [scatter = std::move(scatter), change](const RayBatch& batch, std::span<Scatter> results) {
        scatter(batch, results);
        for (size_t i = 0; i < results.size(); ++i) change(batch, i, results[i]);
    };
}

// Another number of lights than the picture has: parts of lights are not asked for.
ScatterFunction without_parts(ScatterFunction scatter) {
    return [scatter = std::move(scatter)](const RayBatch& batch, std::span<Scatter> results) {
        RayBatch whole = batch;
        whole.parts = {};
        scatter(whole, results);
    };
}

// A plain march in four steps through homogeneous fog and sun light: each step's light and transmittance are taken
// where it ends, or in its middle and integrated.
template<bool at_end> ScatterFunction plain_march(const View&, const Snapshot& snapshot, const Settings&, History*) {
    return [snapshot](const RayBatch& batch, std::span<Scatter> results) {
        constexpr int steps = at_end ? 4 : 256;
        const Medium& fog = snapshot.media[0];
        const Light& sun = snapshot.lights[0];
        for (size_t i = 0; i < results.size(); ++i) {
            const Ray& ray = batch.rays[i];
            const Interval<float> inside = clip(fog.world_bounds, ray.origin, ray.direction, {0, ray.t_max});
            const float step = inside.length() / steps, depth = gray_extinction(fog.optics) * step;
            float passed = 1;
            results[i] = {};
            for (int s = 0; s < steps; ++s) {
                const vec3 at = ray.at(inside.low + step * (static_cast<float>(s) + (at_end ? 1.0f : 0.5f)));
                const double on_the_way = optical_depth(fog, Ray{at, -sun.direction, infinity});
                const float lit = phase_value(fog.optics.phase, -glm::dot(sun.direction, ray.direction)) *
                                  static_cast<float>(std::exp(-on_the_way));
                const float after = passed * std::exp(-depth);
                const float share = at_end ? after * depth : passed - after;
                results[i].radiance += share * lit * fog.optics.albedo * sun.intensity;
                passed = after;
            }
            results[i].transmittance = passed;
        }
    };
}

TEST(MutationCheck, SwappedPhaseSign) {
    expect_caught("phase-sign", broken("march", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                                   History* history) {
                      Snapshot other = snapshot;
                      for (Medium& medium : other.media) medium.optics.phase.g *= -1;
                      return find_mode("march").prepare(view, other, settings, history);
                  }));
}

TEST(MutationCheck, RightEndpointRule) {
    EXPECT_EQ(verdict_of("slab", broken("march", plain_march<false>)), Verdict::holds);
    expect_caught("slab", broken("march", plain_march<true>));
}

TEST(MutationCheck, NoTransmittanceOnTheLightsSide) {
    expect_caught("slab", broken("march", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                             History* history) {
                      Settings other = settings;
                      other.terms.light = LightTransmittance::off;
                      return find_mode("march").prepare(view, snapshot, other, history);
                  }));
}

TEST(MutationCheck, NoTestForTheSecondNappe) {
    expect_caught("mirror-cone", broken("cone", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                                   History* history) {
                      Snapshot both = snapshot;
                      both.lights.push_back(both.lights[0]), both.lights.back().direction *= -1;
                      return without_parts(find_mode("cone").prepare(view, both, settings, history));
                  }));
}

TEST(MutationCheck, NoRejectionOfHistory) {
    const Mode stubborn =
        broken("froxel", [](const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
            if (history && history->frames > 0) { // look the same to whoever compares
                History same;
                update_history(same, view, snapshot, settings);
                history->view = same.view, history->settings = same.settings;
                history->scene = same.scene, history->lights = same.lights;
            }
            return find_mode("froxel").prepare(view, snapshot, settings, history);
        });
    expect_caught("cut", stubborn);
}

TEST(MutationCheck, ShadowsIgnored) {
    expect_caught("dark-room", broken("march", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                                  History* history) {
                      Settings other = settings;
                      other.march.visibility = Visibility::off;
                      return find_mode("march").prepare(view, snapshot, other, history);
                  }));
}

constexpr std::string_view shadowing[] = {"march", "froxel", "shadow-map", "shadow-volume"};

// A mode of `shadowing` to whose fog nothing stands in the way of light.
template<size_t i>
ScatterFunction unshadowed(const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
    Snapshot open = snapshot;
    open.occluders = nullptr;
    return find_mode(shadowing[i]).prepare(view, open, settings, history);
}

// Whether a picture without any shadow has to be told from one with: of a lit floor the fog sees none.
bool shows_shadows(const StressCase& stress) {
    return stress.group == "shadows" && !stress.measure.error && stress.id != "lit-floor";
}

TEST(MutationCheck, NoShadowsInAnyCaseOfShadows) {
    constexpr Prepare prepares[] = {unshadowed<0>, unshadowed<1>, unshadowed<2>, unshadowed<3>};
    for (size_t i = 0; i < std::size(prepares); ++i)
        for (const StressCase& stress : stress_cases()) {
            const Mode mode = broken(shadowing[i], prepares[i]);
            if (!shows_shadows(stress) || !takes_part(stress, mode)) continue;
            const StressResult result = run_stress(stress, {&mode, 1})[0];
            const bool said = std::ranges::any_of(result.points, &StressPoint::wrong);
            EXPECT_TRUE(said || result.verdict() == Verdict::fails) << stress.id << ", " << mode.name;
        }
}

TEST(MutationCheck, LightInADarkRoom) {
    expect_caught("dark-room", broken("froxel", unshadowed<1>));
    expect_caught("dark-room", broken("shadow-map", unshadowed<2>));
    expect_caught("shaft-in-grid", broken("froxel", unshadowed<1>));
}

TEST(MutationCheck, ShadowsAside) {
    expect_caught(
        "slit",
        broken("shadow-map",
               [](const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
                   const auto scene = std::make_shared<Scene>(*snapshot.scene);
                   for (Mesh& mesh : scene->meshes)
                       for (vec3& position : mesh.positions) position.x += 0.3f;
                   Snapshot aside = snapshot;
                   aside.scene = scene.get(), aside.occluders = Occluders::make(*scene, 0, nullptr);
                   const ScatterFunction scatter = find_mode("shadow-map").prepare(view, aside, settings, history);
                   return ScatterFunction([scatter, scene](const RayBatch& batch, std::span<Scatter> results) {
                       scatter(batch, results);
                   });
               }),
        Verdict::degrades);
}

TEST(MutationCheck, PathsATenthTooDark) {
    for (const char* id : {"eye-in-shadow", "near-wall"})
        expect_caught(id, broken("path", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                            History* history) {
                          return changed(find_mode("path").prepare(view, snapshot, settings, history),
                                         [](const RayBatch&, size_t, Scatter& result) { result.radiance *= 0.9f; });
                      }));
}

TEST(MutationCheck, AGhostOfTheSunBehind) {
    Mode ghost = find_mode("radial-blur");
    ghost.prepare_post = [](const View& view, const Snapshot& snapshot, const Settings& settings) {
        Snapshot mirrored = snapshot;
        for (Light& light : mirrored.lights) light.direction *= -1;
        return find_mode("radial-blur").prepare_post(view, mirrored, settings);
    };
    expect_caught("sun-behind", ghost);
}

TEST(MutationCheck, CardsTooBright) {
    expect_caught("many-cards", broken("billboard", [](const View& view, const Snapshot& snapshot,
                                                       const Settings& settings, History* history) {
                      return changed(find_mode("billboard").prepare(view, snapshot, settings, history),
                                     [](const RayBatch&, size_t, Scatter& result) { result.radiance *= 4.0f; });
                  }));
}

TEST(MutationCheck, NotANumberInOnePixel) {
    expect_caught("thin-fog", broken("shadow-volume", [](const View& view, const Snapshot& snapshot,
                                                         const Settings& settings, History* history) {
                      return changed(find_mode("shadow-volume").prepare(view, snapshot, settings, history),
                                     [](const RayBatch& batch, size_t i, Scatter& result) {
                                         if (glm::distance(batch.positions[i], vec2(7.5f)) < 0.1f)
                                             result.radiance.y = NAN;
                                     });
                  }));
}

TEST(MutationCheck, NegativeLightInOnePixel) {
    expect_caught("albedo", broken("cone", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                              History* history) {
                      return changed(find_mode("cone").prepare(view, snapshot, settings, history),
                                     [](const RayBatch& batch, size_t i, Scatter& result) {
                                         if (glm::distance(batch.positions[i], vec2(7.5f)) < 0.1f)
                                             result.radiance.y = -1e-9f;
                                     });
                  }));
}

TEST(MutationCheck, DepthIgnored) {
    expect_caught("near-wall", broken("shadow-map", [](const View& view, const Snapshot& snapshot,
                                                       const Settings& settings, History* history) {
                      const ScatterFunction scatter =
                          find_mode("shadow-map").prepare(view, snapshot, settings, history);
                      return ScatterFunction([scatter](const RayBatch& batch, std::span<Scatter> results) {
                          std::vector<Ray> rays(batch.rays.begin(), batch.rays.end());
                          for (Ray& ray : rays) ray.t_max = 20;
                          RayBatch far = batch;
                          far.rays = rays;
                          scatter(far, results);
                      });
                  }));
}

TEST(MutationCheck, ALightForgotten) {
    expect_caught("many-lamps", broken("march", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                                   History* history) {
                      Snapshot fewer = snapshot;
                      fewer.lights.pop_back();
                      return without_parts(find_mode("march").prepare(view, fewer, settings, history));
                  }));
}

TEST(MutationCheck, TransmittanceSquared) {
    expect_caught("transmittance", broken("froxel", [](const View& view, const Snapshot& snapshot,
                                                       const Settings& settings, History* history) {
                      return changed(find_mode("froxel").prepare(view, snapshot, settings, history),
                                     [](const RayBatch&, size_t, Scatter& result) {
                                         result.transmittance *= result.transmittance;
                                     });
                  }));
}

TEST(MutationCheck, HalfASliceLost) {
    expect_caught("near-wall", broken("froxel", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                                   History* history) {
                      const ScatterFunction scatter = find_mode("froxel").prepare(view, snapshot, settings, history);
                      return ScatterFunction([scatter](const RayBatch& batch, std::span<Scatter> results) {
                          std::vector<Ray> rays(batch.rays.begin(), batch.rays.end());
                          for (Ray& ray : rays) ray.t_max = std::max(0.0f, ray.t_max - 0.02f);
                          RayBatch shorter = batch;
                          shorter.rays = rays;
                          scatter(shorter, results);
                      });
                  }));
}

TEST(MutationCheck, BrightLightClamped) {
    expect_caught("linear", broken("shadow-volume", [](const View& view, const Snapshot& snapshot,
                                                       const Settings& settings, History* history) {
                      return changed(find_mode("shadow-volume").prepare(view, snapshot, settings, history),
                                     [](const RayBatch&, size_t, Scatter& result) {
                                         result.radiance = glm::min(result.radiance, vec3(100));
                                     });
                  }));
}

TEST(MutationCheck, TheLastFogWins) {
    expect_caught("copies", broken("cone", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                              History* history) {
                      Snapshot last = snapshot;
                      last.media = {snapshot.media.back()};
                      return find_mode("cone").prepare(view, last, settings, history);
                  }));
}

TEST(MutationCheck, HalfAVoxelAside) {
    expect_caught("ramp", broken("march", [](const View& view, const Snapshot& snapshot, const Settings& settings,
                                             History* history) {
                      Snapshot aside = snapshot;
                      for (Medium& medium : aside.media) {
                          const auto pool = std::make_shared<BrickPool>(*medium.density.bricks);
                          pool->anchor.x += 0.5f * pool->voxel_size.x;
                          medium.density.bricks = pool;
                      }
                      return find_mode("march").prepare(view, aside, settings, history);
                  }));
}

TEST(MutationCheck, ThreadsShow) {
    expect_caught("threads", broken("billboard", [](const View& view, const Snapshot& snapshot,
                                                    const Settings& settings, History* history) {
                      return changed(find_mode("billboard").prepare(view, snapshot, settings, history),
                                     [](const RayBatch&, size_t, Scatter& result) {
                                         result.radiance += 1e-6f * static_cast<float>(thread_count());
                                     });
                  }));
}

TEST(MutationCheck, LightScatteredAgainForgotten) {
    expect_caught("added-orders", broken("march", [](const View& view, const Snapshot& snapshot,
                                                     const Settings& settings, History* history) {
                      Settings once = settings;
                      once.fluence.orders = 1;
                      return find_mode("march").prepare(view, snapshot, once, history);
                  }));
}

// What has scattered before is added as if there were no surfaces.
ScatterFunction leaking_orders(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    Settings once = settings;
    once.fluence.orders = 1;
    Snapshot open = snapshot;
    open.occluders = nullptr;
    const auto& prepare = find_mode("march").prepare;
    const ScatterFunction single = prepare(view, snapshot, once, nullptr);
    const ScatterFunction open_all = prepare(view, open, settings, nullptr);
    const ScatterFunction open_single = prepare(view, open, once, nullptr);
    return without_parts([=](const RayBatch& batch, std::span<Scatter> results) {
        std::vector<Scatter> all(results.size()), part(results.size());
        single(batch, results), open_all(batch, all), open_single(batch, part);
        for (size_t i = 0; i < results.size(); ++i)
            results[i].radiance += glm::max(all[i].radiance - part[i].radiance, vec3(0));
    });
}
TEST(MutationCheck, LightScatteredAgainThroughFloors) {
    expect_caught("below-floor", broken("march", leaking_orders));
    expect_caught("below-slope", broken("march", leaking_orders));
}

// The eye moves, and the history thinks that it stands.
TEST(MutationCheck, HistoryThatDoesNotFollowTheEye) {
    expect_caught("uncovered", broken("shadow-map", [](const View& view, const Snapshot& snapshot,
                                                       const Settings& settings, History* history) {
                      if (history && history->buffer) {
                          auto standing = std::make_shared<FogBuffer>(*history->buffer);
                          standing->view.camera = view.camera;
                          history->buffer = standing;
                      }
                      return find_mode("shadow-map").prepare(view, snapshot, settings, history);
                  }));
}

TEST(MutationCheck, ALimitationNotSaid) {
    Mode silent = find_mode("cone");
    silent.limitations = [](const View&, const Snapshot&, const Settings&) { return Limitations{}; };
    expect_caught("slit", silent, Verdict::degrades);
}

TEST(MutationCheck, AModeThatAlwaysWarns) {
    Mode anxious = find_mode("march");
    anxious.limitations = [](const View&, const Snapshot&, const Settings&) {
        return Limitations{{Severity::wrong, &limitation::single_scattering_only, Subject::image}};
    };
    const StressCase& stress = *std::ranges::find(stress_cases(), "albedo", &StressCase::id);
    const WrongWarnings warnings = wrong_warnings(run_stress(stress, {&anxious, 1}));
    EXPECT_EQ(warnings.count, static_cast<int>(stress.values.size()));
    EXPECT_EQ(warnings.idle, warnings.count);
}
}
}
