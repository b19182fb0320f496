// Files that the companion reads again: recordings, what the window remembers, results of the campaign.
#include <cstring>
#include <filesystem>
#include <fstream>

#include <campaign/result.hpp>
#include <device/error.hpp>
#include <recording/black_box.hpp>
#include <recording/recording.hpp>
#include <recording/signals.hpp>
#include <temporary_directory.hpp>
#include <window/window_settings.hpp>

#include "target.hpp"

namespace inkwell::fuzz {
namespace {

const Registered campaign_result{
    "campaign_result",
    [](Input input) { refuse_or_take<device::Error>([&] { campaign::parse_result(text_of(input)); }); },
    [] {
      return std::vector<Bytes>{
          bytes_of(campaign::text_of({.number = 7, .fault = "motor_open:2", .off_after_s = 1e-3}))};
    }};

const Registered recording_csv{"recording_csv", [](Input input) {
                                 static const tests::TemporaryDirectory directory;
                                 const std::string file = directory.file("recording.csv");
                                 std::ofstream(file, std::ios::binary) << text_of(input);
                                 refuse_or_take<device::Error>([&] {
                                   const auto recording = recording::read(file);
                                   for (const auto quantity : recording.quantities())
                                     if (recording.column(quantity).size() != recording.size())
                                       throw std::logic_error("a column is too short");
                                 });
                               }};

const Registered signal_names{"signal_names", [](Input input) {
                                refuse_or_take<device::Error>([&] { recording::parse_signals(text_of(input)); });
                                refuse_or_take<device::Error>([&] { recording::parse_quantities(text_of(input)); });
                              }};

/// A report, and then as many rows as there are bytes for.
const Registered black_box{"black_box",
                           [](Input input) {
                             protocol::BlackBoxReport report;
                             if (input.size() < sizeof report) return;
                             std::memcpy(&report, input.data(), sizeof report);
                             input = input.subspan(sizeof report);
                             std::vector<protocol::BlackBoxRow> rows(input.size() / sizeof(protocol::BlackBoxRow));
                             if (!rows.empty()) std::memcpy(rows.data(), input.data(), rows.size() * sizeof rows[0]);
                             refuse_or_take<device::Error>([&] { recording::of_black_box(report, rows, {}); });
                           },
                           [] {
                             protocol::BlackBoxReport report{};
                             report.fault = protocol::Fault::over_speed;
                             report.rows_before = 2;
                             report.row_count = 3;
                             report.fault_periods = 40;
                             Bytes bytes;
                             const auto append = [&](const auto& part) {
                               const auto more = std::as_bytes(std::span(&part, 1));
                               bytes.insert(bytes.end(), more.begin(), more.end());
                             };
                             append(report);
                             for (const std::uint32_t period : {20u, 40u, 60u})
                               append(protocol::BlackBoxRow{period, {}});
                             return std::vector<Bytes>{bytes};
                           }};

const Registered window_settings{
    "window_settings",
    [](Input input) { window::parse_settings(window::format_settings(window::parse_settings(text_of(input)))); },
    [] { return std::vector<Bytes>{bytes_of(window::format_settings({}))}; }};

}  // namespace
}  // namespace inkwell::fuzz
