// Sends a program's forces in a separate thread, so that no caller waits for USB.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "host/client/device/device.hpp"

#include "host/bindings/library/force_interval.hpp"
#include "host/bindings/library/pose_feed.hpp"

namespace inkwell::library {

/// Sends the newest force when the device has received the previous force. In lock step the force is sent before the
/// next pose is requested. A local model needs a report of the same size, so one report contains the newest local model
/// and the newest force.
class ForceOutput : private TurnPart {
 public:
  /// Sends no forces while `poses` reports a loss.
  ForceOutput(device::Device& device, PoseFeed& poses);
  ~ForceOutput();

  void set_mode(protocol::ForceMode mode);
  /// `pose_sequence` belongs to the pose from which the program computed the force. Throws BadArgument if the force is
  /// not finite.
  void send(const double (&force_N)[3], std::uint32_t pose_sequence);
  /// Sends the local model for the pose with this number. If the program answers each pose with a force, the model
  /// waits for the force. Without a new force, the report repeats the newest force for at most `force_life_s` of board
  /// time.
  void send_model(const device::LocalModel& model, std::uint32_t pose_sequence, double force_life_s);
  /// Fades the force out.
  void let_go();
  /// Sets the scheduling priority of the sending thread, as in set_priority().
  void set_thread_priority(int priority) { set_priority(thread_, priority); }
  /// No force is sent after this function returns.
  void stop();

 private:
  void before_pose() override;
  void lose_link(const std::string& cause) override;
  void run();
  /// Sends the queued force if the device accepts the previous report within `patience`.
  void send_next(std::chrono::milliseconds patience);
  /// False after stop().
  bool wait_for_force();
  struct Model {
    device::LocalModel model;
    std::uint32_t pose_sequence = 0;
    double force_life_s = 0;
  };
  bool has_report() const { return next_ || (model_ && model_is_due_); }
  device::ForceRequest take_force();
  /// The newest force for the rest of its interval, or no force after its life.
  device::ForceRequest repeated_force(const Model& model) const;
  void drop_force();

  device::Device& device_;
  PoseFeed& poses_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<device::ForceRequest> next_;
  device::ForceRequest newest_{.mode = protocol::ForceMode::none};  ///< the newest force that was sent
  std::optional<Model> model_;
  bool model_is_due_ = false;  ///< the model does not wait for a force
  protocol::ForceMode mode_ = protocol::ForceMode::instead_of_walls;
  bool stops_ = false;
  ForceInterval interval_;  ///< used by the sending thread
  std::thread thread_;      ///< not used in lock step, where the thread that reads poses sends the forces
};

}  // namespace inkwell::library
