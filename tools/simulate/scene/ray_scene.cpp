#include "tools/simulate/scene/ray_scene.h"

#include <embree3/rtcore.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace maploop::simulate {
namespace {

RTCGeometry mesh_geometry(RTCDevice device, const Mesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  for (const Eigen::Vector3f& v : mesh.vertices)
    for (int i = 0; i < 3; ++i) *vertices++ = v[i];
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle) *indices++ = index;
  rtcCommitGeometry(geometry);
  return geometry;
}

RTCScene scene_of(RTCDevice device, const Mesh& mesh) {
  RTCScene scene = rtcNewScene(device);
  RTCGeometry geometry = mesh_geometry(device, mesh);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);  // built once, then used by every ray
  rtcCommitScene(scene);
  return scene;
}

std::vector<Eigen::Vector3f> normals_of(const Mesh& mesh) {
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(mesh.triangles.size());
  for (const auto& corners : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[corners[0]];
    normals.push_back(
        (mesh.vertices[corners[1]] - a).cross(mesh.vertices[corners[2]] - a).normalized());
  }
  return normals;
}

void set_transform(RTCGeometry instance, unsigned step, const Eigen::Isometry3d& pose) {
  const Eigen::Matrix<float, 3, 4> transform = pose.matrix().topRows<3>().cast<float>();
  rtcSetGeometryTransform(instance, step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
}

alignas(32) constexpr std::array<int, packet> all_valid{-1, -1, -1, -1, -1, -1, -1, -1};

}  // namespace

struct World::Implementation {
  // Embree's parallel builds are not reproducible, so that one thread is used.
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene standing = nullptr;
  std::vector<RTCScene> bodies;
  std::vector<Mesh> meshes;                           // the static one first
  std::vector<std::vector<Eigen::Vector3f>> normals;  // unit, of each mesh
};

World::World(Mesh standing, std::vector<Mesh> bodies)
    : implementation_(std::make_unique<Implementation>()) {
  Implementation& world = *implementation_;
  if (!world.device) throw std::runtime_error("Embree cannot be started on this machine");
  world.meshes.push_back(std::move(standing));
  for (Mesh& body : bodies) world.meshes.push_back(std::move(body));
  for (const Mesh& mesh : world.meshes) world.normals.push_back(normals_of(mesh));
  world.standing = scene_of(world.device, world.meshes.front());
  for (std::size_t i = 1; i < world.meshes.size(); ++i)
    world.bodies.push_back(scene_of(world.device, world.meshes[i]));
  const RTCError error = rtcGetDeviceError(world.device);
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree could not take the scene, error " + std::to_string(error));
}

World::~World() {
  for (RTCScene body : implementation_->bodies) rtcReleaseScene(body);
  if (implementation_->standing) rtcReleaseScene(implementation_->standing);
  if (implementation_->device) rtcReleaseDevice(implementation_->device);
}

struct RayScene::Implementation {
  const World::Implementation* world;
  RTCScene scene;
  std::vector<RTCGeometry> bodies;
};

RayScene::RayScene(const World& world) : implementation_(std::make_unique<Implementation>()) {
  RTCDevice device = world.implementation_->device;
  implementation_->world = world.implementation_.get();
  implementation_->scene = rtcNewScene(device);
  const auto attach = [&](RTCScene what, unsigned steps) {
    RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, what);
    rtcSetGeometryTimeStepCount(instance, steps);
    for (unsigned step = 0; step < steps; ++step)
      set_transform(instance, step, Eigen::Isometry3d::Identity());
    rtcCommitGeometry(instance);
    rtcAttachGeometry(implementation_->scene, instance);
    return instance;
  };
  rtcReleaseGeometry(attach(world.implementation_->standing, 1));
  for (RTCScene body : world.implementation_->bodies)
    implementation_->bodies.push_back(attach(body, 2));
  rtcCommitScene(implementation_->scene);
}

RayScene::~RayScene() {
  for (RTCGeometry body : implementation_->bodies) rtcReleaseGeometry(body);
  rtcReleaseScene(implementation_->scene);
}

void RayScene::move(const std::vector<MovingBody>& bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    set_transform(implementation_->bodies[i], 0, bodies[i].begin);
    set_transform(implementation_->bodies[i], 1, bodies[i].end);
    rtcCommitGeometry(implementation_->bodies[i]);
  }
  rtcCommitScene(implementation_->scene);
}

void RayScene::cast(const Rays& rays, float reach, Hits& hits) const {
  RTCRayHit8 query;
  for (std::size_t i = 0; i < packet; ++i) {
    const Ray& ray = rays[i];
    query.ray.org_x[i] = ray.origin.x();
    query.ray.org_y[i] = ray.origin.y();
    query.ray.org_z[i] = ray.origin.z();
    query.ray.dir_x[i] = ray.direction.x();
    query.ray.dir_y[i] = ray.direction.y();
    query.ray.dir_z[i] = ray.direction.z();
    query.ray.tnear[i] = 0.0F;
    query.ray.tfar[i] = reach;
    query.ray.time[i] = ray.time;
    query.ray.mask[i] = ~0U;
    query.ray.flags[i] = 0;
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(all_valid.data(), implementation_->scene, &context, &query);
  for (std::size_t i = 0; i < packet; ++i) {
    Hit& hit = hits[i];
    hit.any = query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    if (!hit.any) continue;
    hit.range = query.ray.tfar[i];
    const unsigned instance = query.hit.instID[0][i];
    const Mesh& mesh = implementation_->world->meshes[instance];
    const std::uint32_t triangle = query.hit.primID[i];
    const auto& corners = mesh.triangles[triangle];
    const float u = query.hit.u[i], v = query.hit.v[i];
    hit.uv =
        (1.0F - u - v) * mesh.uv[corners[0]] + u * mesh.uv[corners[1]] + v * mesh.uv[corners[2]];
    hit.surface = &mesh.surfaces[mesh.surface_of[triangle]];
    Eigen::Vector3f normal = implementation_->world->normals[instance][triangle];
    if (instance > 0) {
      Eigen::Matrix<float, 3, 4> pose;
      rtcGetGeometryTransform(implementation_->bodies[instance - 1], rays[i].time,
                              RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, pose.data());
      normal = pose.leftCols<3>() * normal;
    }
    hit.normal = normal.dot(rays[i].direction) > 0.0F ? Eigen::Vector3f(-normal) : normal;
  }
}

void RayScene::occluded(const Rays& rays, const std::array<bool, packet>& wanted,
                        std::array<bool, packet>& result) const {
  RTCRay8 query;
  alignas(32) std::array<int, packet> valid;
  for (std::size_t i = 0; i < packet; ++i) {
    valid[i] = wanted[i] ? -1 : 0;
    query.org_x[i] = rays[i].origin.x();
    query.org_y[i] = rays[i].origin.y();
    query.org_z[i] = rays[i].origin.z();
    query.dir_x[i] = rays[i].direction.x();
    query.dir_y[i] = rays[i].direction.y();
    query.dir_z[i] = rays[i].direction.z();
    query.tnear[i] = 0.0F;
    query.tfar[i] = std::numeric_limits<float>::infinity();
    query.time[i] = rays[i].time;
    query.mask[i] = ~0U;
    query.flags[i] = 0;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(valid.data(), implementation_->scene, &context, &query);
  for (std::size_t i = 0; i < packet; ++i) result[i] = wanted[i] && query.tfar[i] < 0.0F;
}

}  // namespace maploop::simulate
