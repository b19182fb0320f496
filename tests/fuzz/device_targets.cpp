// Fuzz targets for data from the USB cable, parameter files and command lines.
#include <array>

#include "boards/arms/description.hpp"
#include "host/client/device/address.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/error.hpp"
#include "host/client/device/force_law.hpp"
#include "host/client/device/parameter_file.hpp"
#include "host/client/device/scope_decoder.hpp"

#include "host/client/device/usb_descriptors.hpp"
#include "tests/firmware/usb/device_bench.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/fuzz/target.hpp"

namespace inkwell::fuzz {
namespace {

const Registered arm_description{
    "arm_description",
    [](Input input) { refuse_or_take<arms::DescriptionError>([&] { arms::parse(text_of(input), "arm.toml"); }); },
    [] { return std::vector<Bytes>{contents_of(INKWELL_SOURCE_DIRECTORY "/boards/arms/omni.toml")}; }};

const Registered parameter_file{
    "parameter_file",
    [](Input input) {
      refuse_or_take<device::Error>([&] {
        const auto file = device::parse_parameters(text_of(input), "parameters.toml");
        device::compare(file, protocol::default_parameters());
      });
    },
    [] { return std::vector<Bytes>{bytes_of(device::format_parameters(protocol::default_parameters()))}; }};

/// The first byte selects the parser of the text.
const Registered words{"words", [](Input input) {
                         if (input.empty()) return;
                         const std::string word = text_of(input.subspan(1));
                         refuse_or_take<device::Error>([&] {
                           switch (std::to_integer<unsigned>(input[0]) % 4) {
                             case 0: device::parse_change(word); break;
                             case 1: device::parse_number(word); break;
                             case 2: device::parse_address(word); break;
                             default: device::parse_server(word); break;
                           }
                         });
                       }};

const Registered usb_descriptors{
    "usb_descriptors",
    [](Input input) {
      refuse_or_take<device::Error>([&] { device::parse_configuration(input); });
      refuse_or_take<device::Error>([&] { device::parse_string(input); });
    },
    [] {
      test::DeviceBench bench;
      return std::vector<Bytes>{bench.get_descriptor(0x0200, 512).data, bench.get_descriptor(0x0302, 255).data};
    }};

const Registered force_law{"force_law",
                           [](Input input) {
                             // The number of joined force laws is limited, because their memory is never freed.
                             static std::size_t joined = 0;
                             constexpr std::size_t joined_maximum = 100'000;
                             refuse_or_take<device::Error>([&] {
                               const device::ForceLaw law = device::parse_force_law(input);
                               if (joined++ < joined_maximum) device::join_tables(law);
                             });
                           },
                           [] {
                             test::DeviceBench bench;
                             bench.configure();
                             const auto id = static_cast<std::uint8_t>(protocol::ReportId::force_law);
                             return std::vector<Bytes>{bench.get_report(3, id, sizeof(protocol::ForceLawReport)).data};
                           }};

constexpr std::uint8_t token = 7;
using protocol::Signal;
constexpr auto chosen_signals = [] {
  protocol::SignalSelection selection{};
  for (const Signal signal : {Signal::position_x_m, Signal::current_1_A, Signal::duty_2, Signal::supply_V})
    selection.signals[selection.count++] = static_cast<std::uint8_t>(signal);
  return selection;
}();

/// Each frame follows its length in two bytes.
const Registered scope_frames{
    "scope_frames",
    [](Input input) {
      device::ScopeDecoder decoder;
      decoder.expect(token, {Signal::position_x_m, Signal::current_1_A, Signal::duty_2, Signal::supply_V});
      while (input.size() >= 2) {
        const auto declared = std::to_integer<std::size_t>(input[0]) | std::to_integer<std::size_t>(input[1]) << 8;
        const std::size_t length = std::min(declared, input.size() - 2);
        if (const auto samples = decoder.decode(input.subspan(2, length)))
          if (samples->values.size() != samples->count * samples->signals.size())
            throw std::logic_error("values are missing");
        input = input.subspan(2 + length);
      }
    },
    [] {
      std::vector<Bytes> examples;
      for (const std::uint32_t periods : {40u, 400u}) {
        link::Link& link = test::fresh_link();
        link.scope.select(chosen_signals, token);
        Bytes frames;
        const auto pass = [&](std::uint32_t period) {
          protocol::SignalValues signals{};
          signals[Signal::supply_V] = static_cast<float>(period / 100);
          test::record(link, signals, period);
          for (auto frame = link.scope.oldest_frame(); !frame.empty(); frame = link.scope.oldest_frame()) {
            frames.push_back(static_cast<std::byte>(frame.size() & 255));
            frames.push_back(static_cast<std::byte>(frame.size() >> 8));
            frames.insert(frames.end(), frame.begin(), frame.end());
            link.scope.release();
          }
        };
        for (std::uint32_t period = 0; period < periods; ++period) pass(period);
        link.scope.select({}, token + 1);  // discards the unfinished frame
        for (int i = 0; i < 3; ++i) pass(periods);
        examples.push_back(std::move(frames));
      }
      return examples;
    }};

}  // namespace
}  // namespace inkwell::fuzz
