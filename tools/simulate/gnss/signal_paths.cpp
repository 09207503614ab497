#include "tools/simulate/gnss/signal_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "msgs/frames.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr double wave = 0.19;          // m, of L1; other carriers diffract and scatter similarly
constexpr float view = 1000.0F;        // m; there is nothing beyond it
constexpr double facade_view = 150.0;  // m
constexpr double weakest = 0.02;       // smallest amplitude that counts

bool is_facade(const Hit& hit) {
  if (!hit.any || std::fabs(hit.normal.z()) > 0.2F) return false;
  return hit.surface->material == Material::plaster || hit.surface->material == Material::brick;
}

// Returns the loss in dB through a material that does not block, or a negative value if it blocks.
double loss_through(Material material) {
  switch (material) {
    case Material::leaf:
      return 2.0;
    case Material::metal:
    case Material::sign:
    case Material::bark:
      return 3.0;
    default:
      return -1.0;
  }
}

double amplitude_of(double loss_db) {
  return std::pow(10.0, -loss_db / 20.0);
}

// Returns the loss in dB behind a knife edge (ITU-R P.526); the ray passes `angle` (rad) below the
// edge, which is `range` (m) away.
double diffraction_loss(double angle, double range) {
  const double v = angle * std::sqrt(2.0 * std::max(1.0, range) / wave);
  return 6.9 + 20.0 * std::log10(std::sqrt((v - 0.1) * (v - 0.1) + 1.0) + v - 0.1);
}

Eigen::Vector3d direction_of(double azimuth, double elevation) {
  return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
          std::sin(elevation)};
}

// Casts all rays; the last packet is filled with copies of its first ray.
template <class Found>
void cast_all(const RayScene& scene, const std::vector<Ray>& rays, float reach, Found&& found) {
  Rays few;
  Hits hits;
  for (std::size_t begin = 0; begin < rays.size(); begin += packet) {
    for (std::size_t i = 0; i < packet; ++i)
      few[i] = rays[begin + i < rays.size() ? begin + i : begin];
    scene.cast(few, reach, hits);
    for (std::size_t i = 0; i < packet && begin + i < rays.size(); ++i) found(few[i], hits[i]);
  }
}

Ray ray(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  return {from.cast<float>(), direction.cast<float>(), 0.0F};
}

}  // namespace

SignalPaths::SignalPaths(const RayScene& scene, const Eigen::Vector3d& antenna,
                         const Eigen::Vector3d& velocity)
    : scene_(scene), antenna_(antenna), velocity_(velocity) {
  find_facades();
}

void SignalPaths::find_facades() {
  constexpr int around = 60;
  std::vector<Ray> rays;
  for (const double elevation : {radians(9.0), radians(24.0)})
    for (int i = 0; i < around; ++i)
      rays.push_back(ray(antenna_, direction_of(2.0 * std::numbers::pi * i / around, elevation)));
  cast_all(scene_, rays, static_cast<float>(facade_view), [&](const Ray& r, const Hit& hit) {
    if (!is_facade(hit)) return;
    const Eigen::Vector3d normal = hit.normal.cast<double>();
    const double distance = -normal.dot(r.direction.cast<double>()) * hit.range;
    // The plane identifies the facade independently of the antenna's position.
    const double place = normal.dot(antenna_) - distance;
    const std::uint64_t name =
        mix(mix(static_cast<std::uint64_t>(std::llround(100.0 * normal.x()) + 1000),
                static_cast<std::uint64_t>(std::llround(100.0 * normal.y()) + 1000)),
            static_cast<std::uint64_t>(std::llround(2.0 * place) + 1'000'000)) |
        1U;
    const bool known = std::any_of(facades_.begin(), facades_.end(),
                                   [&](const Facade& f) { return f.name == name; });
    if (known) return;
    facades_.push_back({normal, distance, 0.15 + 0.45 * unit(mix(hit.surface->seed, 77)), name});
  });
}

SignalPaths::Sight SignalPaths::look(const Eigen::Vector3d& from,
                                     const Eigen::Vector3d& direction) const {
  constexpr int most = 16;
  Sight sight;
  Eigen::Vector3d at = from;
  Rays few;
  Hits hits;
  for (int i = 0; i < most; ++i) {
    few.fill(ray(at, direction));
    scene_.cast(few, view, hits);
    if (!hits[0].any) {
      sight.free = true;
      return sight;
    }
    const double loss = loss_through(hits[0].surface->material);
    sight.range = (at - from).norm() + hits[0].range;
    if (loss < 0.0) return sight;
    sight.loss += loss;
    at += (hits[0].range + 0.05) * direction;
  }
  return sight;
}

void SignalPaths::add_direct(const Eigen::Vector3d& to_satellite,
                             std::vector<SignalPath>& paths) const {
  const Sight sight = look(antenna_, to_satellite);
  if (sight.free) {
    paths.push_back({amplitude_of(sight.loss)});
    return;
  }
  // The signal is diffracted around the edge: search the nearest free direction.
  const double azimuth = std::atan2(to_satellite.x(), to_satellite.y());
  const double elevation = std::asin(to_satellite.z());
  std::vector<Ray> rays;
  std::vector<double> angles;
  for (int step = 1; step <= 5; ++step)
    for (int side = -1; side <= 1; ++side) {
      const double angle = radians(1.5 * step);
      const double up = side == 0 ? angle : 0.0;
      const double across = side * angle / std::max(0.1, std::cos(elevation));
      rays.push_back(ray(antenna_, direction_of(azimuth + across, elevation + up)));
      angles.push_back(angle);
    }
  std::size_t i = 0;
  double least = std::numbers::pi;
  cast_all(scene_, rays, view, [&](const Ray&, const Hit& hit) {
    if (!hit.any) least = std::min(least, angles[i]);
    ++i;
  });
  if (least > 1.0) return;
  least -= radians(0.75);  // half a step
  const double amplitude = amplitude_of(sight.loss + diffraction_loss(least, sight.range));
  if (amplitude > weakest) paths.push_back({amplitude, 0.5 * sight.range * least * least});
}

void SignalPaths::add_reflection(const Facade& facade, const Eigen::Vector3d& to_satellite,
                                 std::vector<SignalPath>& paths) const {
  const double facing = facade.normal.dot(to_satellite);
  if (facing < 0.02) return;  // the signal comes from behind the wall or along it
  const Eigen::Vector3d to_wall = to_satellite - 2.0 * facing * facade.normal;
  const double range = facade.distance / facing;
  if (range > facade_view) return;
  Rays few;
  Hits hits;
  few.fill(ray(antenna_, to_wall));
  scene_.cast(few, static_cast<float>(facade_view), hits);
  const Hit& hit = hits[0];
  if (!is_facade(hit) || std::fabs(hit.range - range) > 0.5 ||
      hit.normal.cast<double>().dot(facade.normal) < 0.98)
    return;
  const Eigen::Vector3d point = antenna_ + range * to_wall;
  const Sight beyond = look(point + 0.05 * facade.normal, to_satellite);
  if (!beyond.free) return;
  // A wave along the wall is reflected fully and keeps its polarization.
  const double polarization = 0.45 + 0.45 * (1.0 - facing) * (1.0 - facing);
  const double amplitude = facade.reflection * polarization * amplitude_of(beyond.loss);
  if (amplitude < weakest) return;
  const double turned = 2.0 * std::numbers::pi * unit(mix(facade.name, 5));
  paths.push_back({amplitude, 2.0 * facade.distance * facing,
                   2.0 * facade.normal.dot(velocity_) * facing, turned, facade.name});
}

std::vector<SignalPath> SignalPaths::from(const Eigen::Vector3d& to_satellite) const {
  std::vector<SignalPath> paths;
  add_direct(to_satellite, paths);
  for (const Facade& facade : facades_) add_reflection(facade, to_satellite, paths);
  std::stable_sort(paths.begin(), paths.end(), [](const SignalPath& a, const SignalPath& b) {
    return a.amplitude > b.amplitude;
  });
  return paths;
}

}  // namespace maploop::simulate
