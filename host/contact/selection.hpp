// Selection of the features for the local model.
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "host/contact/features.hpp"
#include "host/contact/placed_object.hpp"
#include "host/contact/slide.hpp"
#include "host/contact/step.hpp"

namespace inkwell::contact {

/// Time from a pose to the end of the use of its model: 3 ms until the model acts, 3 ms until the next model acts, and
/// the 4 ms delay of the measured velocity.
inline constexpr double model_use_s = 0.010;

/// The features of the nearest surfaces. If the tip is free, surfaces that it will touch in model_use_s precede other
/// surfaces. An edge or a corner becomes its tangent plane if the hand is deeper than the radius: such a hand would
/// pull the proxy of the board around the edge and behind the surface.
Candidates select_features(std::span<const PlacedObject> objects, LimitingFaces limiting, const Pose& pose,
                           const glm::dvec3& proxy_m, double radius_m);

}  // namespace inkwell::contact
