#include "host/client/device/open_arm.hpp"

#include <chrono>
#include <thread>

#include "boards/arms/description.hpp"

namespace inkwell::device {
namespace {

using namespace std::chrono_literals;

constexpr double show_limit_s = 2.0;  // board time limit; the firmware connects to USB after 0.1 s
constexpr double step_s = 0.01;
constexpr auto look_again = 5ms;

Endpoint wait_for_endpoint(const VirtualBoard& board, ControlClient& control, bool time_is_stopped) {
  for (;;) {
    const BoardStatus status = control.status();
    const bool is_late = status.board_time_s > show_limit_s;
    if (const auto endpoint = board.find()) return *endpoint;
    status.insist_on_running();
    if (is_late) throw Error("The virtual board shows no USB device. Check that its firmware is Inkwell's.");
    if (time_is_stopped)
      control.run(step_s);
    else
      std::this_thread::sleep_for(look_again);
  }
}

arms::Description read_description(const std::filesystem::path& file) {
  try {
    return arms::read(file);
  } catch (const arms::DescriptionError& error) {
    throw Error(error.what());
  }
}

std::vector<ParameterChange> parameters_of(const arms::Description& arm) {
  std::vector<ParameterChange> changes;
  for (std::size_t i = 0; i < protocol::parameter_count; ++i)
    if (protocol::parameter_table[i].belongs_to_arm)
      changes.emplace_back(static_cast<protocol::Parameter>(i), arm.parameters.values[i]);
  return changes;
}

OpenArm open_on_own_board(const VirtualBoardOptions& options, std::optional<std::uint64_t> seed, LockStep* lock_step) {
  OpenArm opened;
  std::vector<ParameterChange> arm;
  if (!options.arm.empty()) {
    const arms::Description description = read_description(options.arm);
    arm = parameters_of(description);
    opened.arm_name = description.name;
  }
  opened.board = std::make_unique<VirtualBoard>(options);
  opened.control.emplace(opened.board->control());
  opened.image = opened.board->image();
  opened.arm_description = options.arm;
  if (options.paused) opened.control->stand_by();
  opened.endpoint = wait_for_endpoint(*opened.board, *opened.control, options.paused);
  opened.endpoint.lock_step = lock_step;
  opened.endpoint.seed = seed;
  opened.device = Device::open(opened.endpoint);
  if (!arm.empty()) opened.device->set_parameters(arm);
  return opened;
}

}  // namespace

OpenArm open_arm(const Address& address, VirtualBoardOptions board_options, LockStep* lock_step) {
  OpenArm opened;
  if (address.kind == Address::Kind::own_board) {
    board_options.arm = address.arm;
    if (!address.elf.empty()) board_options.elf = address.elf;
    board_options.seed = address.seed.value_or(board_options.seed);
    opened = open_on_own_board(board_options, address.seed, lock_step);
  } else {
    opened.endpoint = find_arm(address);
    if (opened.endpoint.is_virtual) opened.endpoint.lock_step = lock_step;
    opened.device = Device::open(opened.endpoint);
    if (address.control) opened.control.emplace(*address.control);
  }
  opened.endpoint.serial_number = opened.device->information().serial_number;
  return opened;
}

std::vector<ParameterChange> arm_parameters(const std::filesystem::path& file) {
  return parameters_of(read_description(file));
}

}  // namespace inkwell::device
