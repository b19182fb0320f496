// Durations of CHAI3D's proxy on the same path as `contact-trial speed`. Compiled by tools/lab/contact-speed only,
// because CHAI3D is not part of the build.
#include <chai3d.h>

#include "tests/bench/sliding.hpp"

int main() {
  using namespace inkwell;
  chai3d::cWorld world;
  auto* const mesh = new chai3d::cMesh();  // the world owns the mesh
  world.addChild(mesh);
  const geometry::Mesh ball = sliding::ball();
  for (const glm::vec3& vertex_m : ball.vertices_m) mesh->newVertex(vertex_m.x, vertex_m.y, vertex_m.z);
  for (const auto& [a, b, c] : ball.faces) mesh->newTriangle(a, b, c);
  mesh->createAABBCollisionDetector(sliding::tip_radius_m);
  mesh->m_material->setStiffness(500);
  mesh->setUseTransparency(false);
  mesh->setFriction(0, 0);
  world.computeGlobalPositions(true);
  for (const bool dynamic : {false, true})
    for (const bool free : {false, true}) {
      chai3d::cAlgorithmFingerProxy proxy;
      proxy.setProxyRadius(sliding::tip_radius_m);
      proxy.m_useDynamicProxy = dynamic;
      const glm::dvec3 first_m = sliding::hand_m(-sliding::approach_steps, free);
      proxy.initialize(&world, chai3d::cVector3d(first_m.x, first_m.y, first_m.z));
      const char* const name = free ? (dynamic ? "CHAI3D, dynamic proxy, free" : "CHAI3D, static proxy, free")
                                    : (dynamic ? "CHAI3D, dynamic proxy, sliding" : "CHAI3D, static proxy, sliding");
      sliding::measure(name, free, [&](const glm::dvec3& hand_m) {
        const chai3d::cVector3d force_N =
            proxy.computeForces(chai3d::cVector3d(hand_m.x, hand_m.y, hand_m.z), chai3d::cVector3d(0, 0, 0));
        return force_N.length() > 0;
      });
    }
}
