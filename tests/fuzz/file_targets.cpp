// Fuzz targets for the companion's input files: recordings, window settings, and campaign results.
#include <cstring>
#include <memory>
#include <sstream>
#include <utility>

#include "host/client/device/error.hpp"
#include "host/client/firmware_update/boot_loader.hpp"
#include "host/client/firmware_update/image.hpp"
#include "host/client/recording/black_box.hpp"
#include "host/client/recording/recording.hpp"
#include "host/client/recording/signals.hpp"
#include "host/companion/window/scope/formula.hpp"
#include "host/companion/window/window_settings.hpp"
#include "host/lab/campaign/result.hpp"

#include "host/client/recording/formats.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/host/client/firmware_update/made_elf.hpp"

namespace inkwell::fuzz {
namespace {

const Registered campaign_result{
    "campaign_result",
    [](Input input) { refuse_or_take<device::Error>([&] { campaign::parse_result(text_of(input)); }); },
    [] {
      return std::vector<Bytes>{bytes_of(campaign::text_of(
          {.number = 7, .fault = campaign::find_fault("motor_open:2").value(), .off_after_s = 1e-3}))};
    }};

/// The recording is read from memory, because file accesses would take most of the time.
const Registered recording_csv{"recording_csv", [](Input input) {
                                 // Only the first force laws are joined, because their memory is never freed.
                                 static std::size_t laws = 0;
                                 constexpr std::size_t laws_maximum = 1000;
                                 std::string text = text_of(input);
                                 constexpr std::string_view key = "# force_law = ";
                                 for (auto at = text.find(key); at != text.npos; at = text.find(key, at + 1))
                                   if (++laws > laws_maximum) text[at + 2] = 'F';
                                 auto stream = std::make_unique<std::istringstream>(text);
                                 refuse_or_take<device::Error>([&] {
                                   const auto stored = recording::open_csv(std::move(stream), "recording.csv");
                                   const auto recording = stored.load(stored.quantities());
                                   for (const auto quantity : recording.quantities())
                                     if (recording.column(quantity).size() != recording.size())
                                       throw std::logic_error("a column is too short");
                                   recording::log_text(stored);
                                   recording.lost();
                                   const std::size_t end = recording.size();
                                   for (std::size_t begin = 0; begin < end;) {
                                     const std::size_t next = recording.end_of_stretch(begin, end);
                                     recording.samples(begin, next);
                                     begin = next;
                                   }
                                 });
                               }};

const Registered signal_names{"signal_names", [](Input input) {
                                refuse_or_take<device::Error>([&] { recording::parse_signals(text_of(input)); });
                                refuse_or_take<device::Error>([&] { recording::parse_quantities(text_of(input)); });
                              }};

/// The input is a report and black-box rows.
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

/// An ELF file with any content.
const Registered firmware_image{"firmware_image",
                                [](Input input) {
                                  refuse_or_take<firmware_update::NoImage>([&] {
                                    const auto image = firmware_update::read_image(input, "any.elf");
                                    if (image.segments.empty()) throw std::logic_error("an image without bytes");
                                    for (std::size_t i = 1; i < image.segments.size(); ++i)
                                      if (image.segments[i].address < image.segments[i - 1].end())
                                        throw std::logic_error("segments overlap");
                                    if (image.identity) firmware_update::describe(*image.identity);
                                    firmware_update::objections(image, image.identity);
                                  });
                                },
                                [] {
                                  protocol::ImageIdentity identity{};
                                  return std::vector<Bytes>{tests::made_elf(tests::made_segments(identity))};
                                }};

/// The input is a boot loader's memory description.
const Registered memory_layout{"memory_layout",
                               [](Input input) {
                                 const auto sectors = firmware_update::parse_memory_layout(text_of(input));
                                 for (std::size_t i = 1; i < sectors.size(); ++i)
                                   if (sectors[i].address - sectors[i - 1].address != sectors[i - 1].bytes)
                                     throw std::logic_error("a sector does not follow the one before it");
                               },
                               [] {
                                 return std::vector<Bytes>{
                                     bytes_of("@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg"),
                                     bytes_of("@Option Bytes  /0x1FFFC000/01*016 e")};
                               }};

/// Each accepted formula is evaluated.
const Registered typed_formula{"formula",
                               [](Input input) {
                                 window::Formula formula{.name = "typed", .text = text_of(input), .unit = "1"};
                                 if (!window::refusal_of(formula).empty()) return;
                                 window::FormulaValues values(formula);
                                 const std::vector<float> row(values.inputs().size(), 0.5f);
                                 for (int i = 0; i < 3; ++i) values.next(row);
                                 window::find_unit(formula.text);
                               },
                               [] {
                                 return std::vector<Bytes>{bytes_of("force_x_N - program_force_x_N"),
                                                           bytes_of("sqrt(force_x_N^2 + 1.5e-3 * abs(force_y_N))")};
                               }};

}  // namespace
}  // namespace inkwell::fuzz
