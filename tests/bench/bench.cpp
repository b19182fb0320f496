// Measures the speed of the virtual board, and the cost of each stage of the control interrupt.
#include <atomic>
#include <cstdio>
#include <thread>

#include <benchmark/benchmark.h>

#include "boards/omni_driver/facts.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"

#include "tests/bench/interrupt_stages.hpp"

namespace {

using namespace inkwell;
using namespace std::chrono_literals;
using protocol::Signal;

class BusyBoard {
 public:
  explicit BusyBoard(device::SimulationMode mode)
      : board_(options(mode)), control_(board_.control()), device_(open(board_, control_)) {
    control_.resume();
    device_->select_signals(signals);
    control_.pause();
    pose_reader_ = std::thread([this] {
      while (!stop_) device_->read_pose(10ms);
    });
    scope_reader_ = std::thread([this] {
      while (!stop_) device_->read_scope(10ms);
    });
  }
  ~BusyBoard() {
    stop_ = true;
    pose_reader_.join();
    scope_reader_.join();
  }

  void run(double time_s) { control_.run(time_s); }

  // clang-format off
  static constexpr std::array signals{
      Signal::servo_cycles,         Signal::stage_sample_cycles,  Signal::stage_pose_cycles,
      Signal::stage_contact_cycles, Signal::stage_torque_cycles,  Signal::stage_current_cycles,
      Signal::stage_report_cycles,  Signal::position_x_m,         Signal::position_y_m,
      Signal::position_z_m,         Signal::force_N,              Signal::torque_1_Nm,
      Signal::torque_2_Nm,          Signal::torque_3_Nm};
  // clang-format on

 private:
  static device::VirtualBoardOptions options(device::SimulationMode mode) {
    device::VirtualBoardOptions options;
    options.mode = mode;
    options.real_time = false;
    options.paused = true;
    return options;
  }
  static std::unique_ptr<device::Device> open(device::VirtualBoard& board, device::ControlClient& control) {
    control.resume();
    std::optional<device::Endpoint> endpoint;
    while (!endpoint) endpoint = board.find();
    auto device = device::Device::open(*endpoint);
    control.pause();
    return device;
  }
  device::VirtualBoard board_;
  device::ControlClient control_;
  std::unique_ptr<device::Device> device_;
  std::atomic<bool> stop_ = false;
  std::thread pose_reader_, scope_reader_;
};

void virtual_board(benchmark::State& state, device::SimulationMode mode) {
  BusyBoard board(mode);
  board.run(0.5);
  double board_s = 0;
  for (auto _ : state) {
    board.run(1.0);
    board_s += 1.0;
  }
  state.counters["times_real_time"] = benchmark::Counter(board_s, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(virtual_board, fast, device::SimulationMode::fast)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(5);
BENCHMARK_CAPTURE(virtual_board, exact, device::SimulationMode::exact)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(5);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  inkwell::bench::print_interrupt_stages();
  benchmark::RunSpecifiedBenchmarks();
}
