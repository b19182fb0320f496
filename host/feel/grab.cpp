#include "host/feel/grab.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace inkwell::feel {
namespace {

/// Constant angular velocity that turns one rotation into the other within the time.
glm::dvec3 spin_between(const glm::dquat& from, const glm::dquat& to, double time_s) {
  glm::dquat turn = to * glm::conjugate(from);
  if (turn.w < 0) turn = -turn;
  const glm::dvec3 axis{turn.x, turn.y, turn.z};
  const double sine = glm::length(axis);
  if (!(sine > 1e-12)) return {};
  return axis * (2 * std::atan2(sine, turn.w) / (sine * time_s));
}

}  // namespace

void Grab::begin(const contact::Object& object, const HandPlacement& hand, double time_s) {
  is_holding_ = true;
  object_ = object.id;
  const glm::dquat to_hand = glm::conjugate(hand.rotation);
  in_hand_ = {to_hand * (object.placement.position_m - hand.position_m), to_hand * object.placement.rotation};
  count_ = 0;
  add({time_s, object.placement});
}

void Grab::follow(contact::Object& object, const HandPlacement& hand, double time_s) {
  object.placement = {hand.position_m + hand.rotation * in_hand_.position_m,
                      glm::normalize(hand.rotation * in_hand_.rotation)};
  add({time_s, object.placement});
  const Sample& oldest = samples_.front();
  const double passed_s = time_s - oldest.time_s;
  object.velocity_m_per_s = object.spin_rad_per_s = {};
  if (!(passed_s > 0)) return;
  object.velocity_m_per_s = (object.placement.position_m - oldest.placement.position_m) / passed_s;
  object.spin_rad_per_s = spin_between(oldest.placement.rotation, object.placement.rotation, passed_s);
}

void Grab::end(contact::Object& object) {
  object.velocity_m_per_s = object.spin_rad_per_s = {};
  is_holding_ = false;
}

void Grab::add(const Sample& sample) {
  if (count_ > 0 && sample.time_s < samples_[count_ - 1].time_s) count_ = 0;
  const auto end = samples_.begin() + static_cast<std::ptrdiff_t>(count_);
  auto first =
      std::find_if(samples_.begin(), end, [&](const Sample& each) { return sample.time_s - each.time_s <= span_s; });
  if (first == samples_.begin() && count_ == samples_.size()) ++first;
  count_ = static_cast<std::size_t>(std::move(first, end, samples_.begin()) - samples_.begin());
  samples_[count_++] = sample;
}

}  // namespace inkwell::feel
