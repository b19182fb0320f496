// The pane that leads through a guide: what will happen, the numbers as they are measured, the step response, and the
// buttons Confirm, Cancel and Apply.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <device_desk/device_desk.hpp>
#include <frame/style.hpp>
#include <guides/guides.hpp>
#include <guides/session_port.hpp>
#include <guides/simulated_user.hpp>

namespace inkwell::window {

class GuidesPane {
 public:
  /// `control_port`: of the virtual board whose simulated hand can do the user's part; 0 for a real device.
  /// `simulated_arm`: the arm of that board, if it is known otherwise than from the device.
  GuidesPane(DeviceDesk& desk, std::uint16_t control_port, std::optional<protocol::ParameterSet> simulated_arm)
      : desk_(desk), control_port_(control_port), simulated_arm_(simulated_arm) {}
  /// Closing the window in the middle of a guide leaves neither force nor parameters on trial on the device.
  ~GuidesPane() { cancel(); }
  GuidesPane(const GuidesPane&) = delete;
  GuidesPane& operator=(const GuidesPane&) = delete;

  /// Once a frame, with the scope's frames since the last one, whether the pane is shown or not.
  void follow(const std::vector<device::ScopeSamples>& frames);
  void draw(ImVec2 place, ImVec2 size, const Style& style);

  /// Ends a guide that runs, motors off. The stop button does this.
  void cancel();
  bool is_running() const { return guide_ && !guide_->is_over(); }
  /// The scope belongs to the guide while there are any.
  const std::vector<protocol::Signal>& signals() const { return signals_; }

 private:
  struct Offer {
    const char* title;
    const char* help;
    std::function<guides::Guide()> make;
  };
  std::vector<Offer> offers() const;
  void start(guides::Guide guide);
  void draw_offers(const Style& style);
  void draw_step(const Style& style);
  void draw_checks(const Style& style);
  void draw_result(const Style& style);
  void draw_curves(const Style& style);
  void draw_buttons(const Style& style);
  guides::SessionPort port();
  void run_simulated_user();

  DeviceDesk& desk_;
  std::uint16_t control_port_;
  std::optional<protocol::ParameterSet> simulated_arm_;
  bool hand_helps_ = true;
  float bandwidth_Hz_ = static_cast<float>(guides::bandwidth_default_Hz);
  std::optional<guides::Guide> guide_;
  std::optional<guides::SimulatedUser> user_;
  std::string user_problem_;
  std::vector<protocol::Signal> signals_;
};

}  // namespace inkwell::window
