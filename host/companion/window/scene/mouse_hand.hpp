// Moves the simulated hand of a virtual board with the mouse. A separate thread communicates with the board, so that
// the window never blocks.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <glm/glm.hpp>

#include "host/client/device/socket_address.hpp"

namespace inkwell::window {

/// Typical stiffness, damping and force limit of a human hand on the stylus.
inline constexpr double hand_stiffness_N_per_m = 150.0;
inline constexpr double hand_damping_Ns_per_m = 2.0;
inline constexpr float hand_pull_maximum_N = 2.8f;

/// Limits the distance between the hand's target and the probe.
glm::vec3 within_reach(glm::vec3 probe_m, glm::vec3 wanted_m);

class MouseHand {
 public:
  explicit MouseHand(device::SocketAddress control);
  ~MouseHand();

  /// Grasps the stylus and pulls the probe to a workspace position. Removes the stylus from the inkwell if necessary.
  void pull_to(glm::vec3 target_m);
  void let_go();
  void put_into_inkwell();
  /// Puts the stylus into the inkwell. If the stylus is in the inkwell, takes it out first, because the board
  /// references the encoders when the stylus arrives.
  void reference_encoders();
  void press_buttons(bool first, bool second);

  /// Returns the target of the hand; empty if the hand does not grasp the stylus.
  std::optional<glm::vec3> target_m() const;
  bool is_docked() const;
  std::string error() const;  ///< empty while the board answers

 private:
  struct Wish {
    bool docked = true;  ///< the virtual board starts with the stylus in the inkwell
    std::optional<glm::vec3> target_m;
    bool first_button = false;
    bool second_button = false;
    int references = 0;  ///< number of requests to reference the encoders
    bool operator==(const Wish&) const = default;
  };

  void run(const std::stop_token& stop);
  void change(const Wish& wish);
  /// Waits outside the inkwell. Returns early if the thread must stop.
  void wait_outside(const std::stop_token& stop);

  device::SocketAddress control_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  Wish wish_;
  std::string error_;
  std::jthread thread_;
};

}  // namespace inkwell::window
