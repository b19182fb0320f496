// Fuzz targets for the companion's socket input: answers of a USB/IP server and of a virtual board.
#include <cstring>
#include <stdexcept>

#include "host/client/device/error.hpp"

#include "host/client/device/control_answers.hpp"
#include "host/client/device/usbip_answers.hpp"
#include "tests/fuzz/target.hpp"

namespace inkwell::fuzz {
namespace {

using nlohmann::json;

/// The first byte selects device list, import or transfers. The input for transfers is a script of IN transfers, OUT
/// transfers, cancellations and answers.
const Registered usbip_answers{
    "usbip_answers", [](Input input) {
      const auto next = [&](std::size_t size) {
        if (size > input.size()) throw device::Disconnected("The input is over.");
        const Input bytes = input.first(size);
        input = input.subspan(size);
        return bytes;
      };
      const auto number = [&] { return std::to_integer<std::uint32_t>(next(1)[0]); };
      const device::ReceiveBytes receive = [&](std::span<std::byte> bytes) {
        std::ranges::copy(next(bytes.size()), bytes.begin());
      };
      refuse_or_take<device::Error>([&] {
        const std::uint32_t kind = number() % 4;
        if (kind == 0) {
          const std::size_t most = input.size() / sizeof(usbip::Device);
          if (device::receive_device_list(receive).size() > most) throw std::logic_error("devices out of nothing");
          return;
        }
        if (kind == 1) {
          device::receive_import(receive);
          return;
        }
        device::OpenTransfers open;
        std::uint32_t sequence = 0, asked = 0, ended = 0;
        const auto ask = [&](usbip::Direction direction) {
          const std::uint32_t low = number(), length = low | number() << 8;
          open.add(++sequence,
                   {direction, length, [&ended, direction, length](const device::UsbipCompletion& completion) {
                      ++ended;
                      const bool has_data = direction == usbip::Direction::in;
                      if (completion.length > length || completion.data.size() != (has_data ? completion.length : 0))
                        throw std::logic_error("an answer is longer than its transfer");
                    }});
          ++asked;
        };
        const auto end_all = [&] {
          for (const auto& transfer : open.take_all()) transfer.on_completion({});
          if (ended != asked) throw std::logic_error("a transfer ended not once");
        };
        try {
          for (;;) switch (number() % 4) {
              case 0: ask(usbip::Direction::in); break;
              case 1: ask(usbip::Direction::out); break;
              case 2: {
                const std::uint32_t taken_back = number();
                if (open.contains(taken_back)) open.unlink(++sequence, taken_back);
                break;
              }
              default: {
                const auto answer = device::receive_message<usbip::ReturnSubmit>(receive);
                std::vector<std::byte> data(open.data_length_of(answer));
                receive(data);
                if (auto answered = open.take(answer, std::move(data)))
                  answered->on_completion(std::move(answered->completion));
                break;
              }
            }
        } catch (const device::Error&) {
          end_all();
        }
      });
    }};

/// The first byte chooses the request.
const Registered control_answers{"control_answers", [](Input input) {
                                   if (input.empty()) return;
                                   refuse_or_take<device::Error>([&] {
                                     const json answer = device::parse_answer(text_of(input.subspan(1)), "any");
                                     switch (std::to_integer<unsigned>(input[0]) % 6) {
                                       case 0: device::status_of(answer); break;
                                       case 1: device::pin_levels_of(answer); break;
                                       case 2:
                                         device::injection_of(answer, {.fault = "supply_sag", .for_s = 0.5});
                                         break;
                                       case 3: device::injections_of(answer); break;
                                       case 4: device::meter_reading_of(answer); break;
                                       default: {
                                         const auto trace = device::trace_of(answer);
                                         if (trace.values.size() != trace.row_count() * trace.columns.size())
                                           throw std::logic_error("values are missing");
                                         break;
                                       }
                                     }
                                   });
                                 }};

}  // namespace
}  // namespace inkwell::fuzz
