#include "tests/boards/virtual/usb/fake_firmware.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace inkwell::virtual_usb_test {

namespace {
constexpr std::uint32_t gahbcfg = 0x008, gusbcfg = 0x00C, grstctl = 0x010, gintsts = 0x014, gintmsk = 0x018,
                        grxstsp = 0x020, grxfsiz = 0x024, dieptxf0 = 0x028, gccfg = 0x038, dieptxf1 = 0x104,
                        dieptxf2 = 0x108, dcfg = 0x800, dctl = 0x804, diepmsk = 0x810, doepmsk = 0x814, daint = 0x818,
                        daintmsk = 0x81C, diepempmsk = 0x834;
constexpr std::uint32_t diepctl(unsigned n) { return 0x900 + 0x20 * n; }
constexpr std::uint32_t diepint(unsigned n) { return 0x908 + 0x20 * n; }
constexpr std::uint32_t dieptsiz(unsigned n) { return 0x910 + 0x20 * n; }
constexpr std::uint32_t dtxfsts(unsigned n) { return 0x918 + 0x20 * n; }
constexpr std::uint32_t doepctl(unsigned n) { return 0xB00 + 0x20 * n; }
constexpr std::uint32_t doepint(unsigned n) { return 0xB08 + 0x20 * n; }
constexpr std::uint32_t doeptsiz(unsigned n) { return 0xB10 + 0x20 * n; }
constexpr std::uint32_t fifo(unsigned n) { return 0x1000 * (n + 1); }

constexpr std::uint32_t epena = 1u << 31, epdis = 1u << 30, sd0pid = 1u << 28, snak = 1u << 27, cnak = 1u << 26,
                        stall = 1u << 21, usbaep = 1u << 15;
constexpr std::uint32_t type_bulk = 2u << 18, type_interrupt = 3u << 18;

constexpr std::array<std::uint8_t, 18> device_descriptor{18,   1,    0x00, 0x02, 0,    0, 0, 64, 0x09,
                                                         0x12, 0x01, 0x00, 0x34, 0x01, 0, 0, 0,  1};
constexpr std::array<std::uint8_t, 55> configuration_descriptor{
    9, 2, 55,   0, 2,  5,    0, 0x80, 50,  // configuration 5
    9, 4, 0,    0, 2,  3,    0, 0,    0,   // interface 0, HID
    7, 5, 0x81, 3, 64, 0,    1,            //
    7, 5, 0x01, 3, 64, 0,    1,            //
    9, 4, 1,    0, 2,  0xFF, 1, 2,    0,   // interface 1, vendor
    7, 5, 0x82, 2, 64, 0,    0,            //
    7, 5, 0x03, 2, 64, 0,    0};
}  // namespace

void FakeFirmware::start() {
  set(gusbcfg, 1u << 6);
  set(grstctl, 1);
  wait_until_clear(grstctl, 1);
  scheduler_.run_until(scheduler_.now() + virtual_board::ticks(1e-6));
  write(gusbcfg, 1u << 30 | 6u << 10 | 1u << 6);
  scheduler_.pass_until(scheduler_.now() + virtual_board::ticks(0.025));
  write(gccfg, 1u << 21 | 1u << 16);
  set(dcfg, 3);
  set(dctl, 2);
  write(gintsts, 0xFFFF'FFFF);
  write(gintmsk, 1u << 3 | 1u << 4 | 1u << 11 | 1u << 12 | 1u << 13 | 1u << 18 | 1u << 19);
  write(gahbcfg, 1);
  write(dctl, read(dctl) & ~2u);
}

void FakeFirmware::handle_interrupt() {
  const std::uint32_t status = read(gintsts) & read(gintmsk);
  if ((status & 1u << 12) != 0) bus_reset();
  if ((status & 1u << 13) != 0) {
    write(gintsts, 1u << 13);
    write(diepctl(0), read(diepctl(0)) & ~3u);
    write(dctl, read(dctl) | 1u << 8);
  }
  if ((status & 1u << 11) != 0) {
    write(gintsts, 1u << 11);
    ++suspends;
  }
  if ((status & 1u << 3) != 0) {
    write(gintsts, 1u << 3);
    ++frames;
  }
  while ((read(gintsts) & 1u << 4) != 0) receive_word();
  if ((read(gintsts) & 1u << 19) != 0) {
    for (unsigned n = 0; n < 4; ++n) {
      const std::uint32_t interrupts = read(doepint(n));
      write(doepint(n), interrupts);
      if (n == 0 && (interrupts & 1u << 3) != 0 && answers_requests) handle_setup();
      if ((interrupts & 1) == 0) continue;
      if (n == 0) {
        if (control_out_expected_ > 0 && control_received.size() >= control_out_expected_) {
          control_out_expected_ = 0;
          answer({}, 0);
        } else {
          arm_control_out();
        }
      } else if (n != 3 || bulk_taken_) {
        arm_out(n);
      }
    }
  }
  if ((read(gintsts) & 1u << 18) != 0) {
    for (unsigned n = 0; n < 3; ++n) {
      if ((read(daint) & 1u << n) == 0) continue;
      const std::uint32_t interrupts = read(diepint(n));
      write(diepint(n), interrupts);
      if (n == 2) fill_stream();
      if ((interrupts & 1) == 0) continue;
      if (n == 0 && control_in_active_) send_control_packet();
      if (n == 1) {
        ++reports_sent;
        if (report_every_millisecond) {
          Bytes report(64);
          std::memcpy(report.data(), &reports_sent, sizeof reports_sent);
          send_report(report);
        }
      }
    }
  }
}

void FakeFirmware::bus_reset() {
  write(gintsts, 1u << 12);
  ++resets;
  configuration = 0;
  control_in_active_ = false;
  control_out_expected_ = 0;
  stream_running_ = false;
  for (unsigned n = 0; n < 4; ++n) write(doepctl(n), snak);
  stop_everything();
  flush_transmit(0x10);
  write(diepempmsk, 0);
  write(daintmsk, 0x0001'0001);
  write(doepmsk, 1u << 3 | 1);
  write(diepmsk, 1);
  write(grxfsiz, 56);
  write(dieptxf0, 16u << 16 | 56);
  write(dieptxf1, 16u << 16 | 72);
  write(dieptxf2, 128u << 16 | 88);
  write(dcfg, read(dcfg) & ~(0x7Fu << 4));
  address = 0;
  write(doeptsiz(0), 3u << 29 | 1u << 19 | 64);
}

// The core keeps endpoints enabled and the receive FIFO filled during a bus reset.
void FakeFirmware::stop_everything() {
  for (unsigned n = 0; n < 4; ++n) stop_in(n);
  write(dctl, read(dctl) | 1u << 9);
  while ((read(gintsts) & 1u << 7) == 0) {
    const std::uint32_t status = read(grxstsp);
    for (std::size_t i = 0; i < (status >> 4 & 0x7FF); i += 4) read(fifo(0));
  }
  for (unsigned n = 1; n < 4; ++n)
    if ((read(doepctl(n)) & epena) != 0) {
      set(doepctl(n), epdis | snak);
      wait_until_clear(doepctl(n), epena);
    }
  for (unsigned n = 0; n < 4; ++n) {
    write(diepint(n), ~0u);
    write(doepint(n), ~0u);
  }
  write(dctl, read(dctl) | 1u << 10);
}

void FakeFirmware::stop_in(unsigned endpoint) {
  if ((read(diepctl(endpoint)) & epena) == 0) return;
  set(diepctl(endpoint), epdis | snak);
  wait_until_clear(diepctl(endpoint), epena);
}

void FakeFirmware::flush_transmit(unsigned fifo) {
  write(grstctl, fifo << 6 | 1u << 5);
  wait_until_clear(grstctl, 1u << 5);
}

void FakeFirmware::wait_until_clear(std::uint32_t offset, std::uint32_t bits) {
  while ((read(offset) & bits) != 0) scheduler_.run_until(scheduler_.now() + virtual_board::ticks(50e-9));
}

void FakeFirmware::receive_word() {
  const std::uint32_t status = read(grxstsp);
  const unsigned endpoint = status & 15;
  const std::size_t length = (status >> 4) & 0x7FF;
  const unsigned kind = (status >> 17) & 15;
  Bytes data;
  for (std::size_t i = 0; i < length; i += 4) {
    const std::uint32_t word = read(fifo(0));
    for (std::size_t j = 0; j < std::min<std::size_t>(4, length - i); ++j) data.push_back(std::byte(word >> (8 * j)));
  }
  if (kind == 6) {
    ++setups;
    std::copy(data.begin(), data.end(), setup_.begin());
    if (clears_nak_too_early) set(doepctl(0), cnak);
  } else if (kind == 4) {
    ++setup_done;
  } else if (kind == 2) {
    Bytes& sink = endpoint == 0 ? control_received : endpoint == 1 ? report_received : bulk_received;
    sink.insert(sink.end(), data.begin(), data.end());
  }
}

void FakeFirmware::handle_setup() {
  const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(setup_[i]); };
  const unsigned type = byte(0), request = byte(1), value = byte(2) | byte(3) << 8;
  const auto length = static_cast<std::uint16_t>(byte(6) | byte(7) << 8);
  write(doeptsiz(0), 3u << 29 | 1u << 19 | 64);
  control_in_active_ = false;
  control_out_expected_ = 0;
  if ((read(diepctl(0)) & epena) != 0) {  // the host has abandoned an earlier request
    stop_in(0);
    flush_transmit(0);
  }
  if (type == 0x80 && request == 6 && value >> 8 == 1) {
    answer(std::as_bytes(std::span(device_descriptor)), length);
  } else if (type == 0x80 && request == 6 && value >> 8 == 2) {
    auto descriptor = configuration_descriptor;
    descriptor[24] = report_interval;
    answer(std::as_bytes(std::span(descriptor)), length);
  } else if (type == 0 && request == 5) {
    address = static_cast<std::uint8_t>(value);
    write(dcfg, read(dcfg) | value << 4);
    answer({}, 0);
  } else if (type == 0 && request == 9) {
    configuration = static_cast<std::uint8_t>(value);
    configure();
    answer({}, 0);
  } else if (type == 2 && request == 1 && byte(4) == 0x82) {
    write(diepctl(2), (read(diepctl(2)) & ~(stall | epena)) | sd0pid);
    answer({}, 0);
  } else if (type == 0xC0 && request == 1) {
    Bytes blob(value);
    for (std::size_t i = 0; i < blob.size(); ++i) blob[i] = pattern(i);
    answer(blob, length);
  } else if (type == 0x40 && request == 2) {
    control_received.clear();
    control_out_expected_ = length;
    if (length == 0)
      answer({}, 0);
    else
      arm_control_out();
  } else {
    stall_control();
  }
}

void FakeFirmware::answer(std::span<const std::byte> data, std::uint16_t length_asked) {
  const std::size_t length = std::min<std::size_t>(data.size(), length_asked);
  control_in_.assign(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(length));
  control_in_sent_ = 0;
  control_in_active_ = true;
  control_in_needs_empty_packet_ = length == 0 || (length < length_asked && length % 64 == 0);
  send_control_packet();
  if (length_asked > 0) arm_control_out();  // for the status stage
}

void FakeFirmware::send_control_packet() {
  const std::size_t length = std::min<std::size_t>(64, control_in_.size() - control_in_sent_);
  if (length == 0 && !control_in_needs_empty_packet_) {
    control_in_active_ = false;
    return;
  }
  if (length < 64) control_in_needs_empty_packet_ = false;
  write(dieptsiz(0), 1u << 19 | static_cast<std::uint32_t>(length));
  set(diepctl(0), epena | cnak);
  write_packet(0, std::span(control_in_).subspan(control_in_sent_, length));
  control_in_sent_ += length;
}

void FakeFirmware::stall_control() {
  set(diepctl(0), stall);
  set(doepctl(0), stall);
}

void FakeFirmware::arm_control_out() {
  write(doeptsiz(0), 3u << 29 | 1u << 19 | 64);
  set(doepctl(0), epena | cnak);
}

void FakeFirmware::configure() {
  write(diepctl(1), sd0pid | 1u << 22 | type_interrupt | usbaep | 64);
  write(diepctl(2), sd0pid | 2u << 22 | type_bulk | usbaep | 64);
  write(doepctl(1), sd0pid | type_interrupt | usbaep | 64);
  write(doepctl(3), sd0pid | type_bulk | usbaep | 64);
  set(daintmsk, 1u << 1 | 1u << 2 | 1u << 17 | 1u << 19);
  arm_out(1);
  if (bulk_taken_) arm_out(3);
  if (report_every_millisecond) send_report(Bytes(64));
  if (stream_wanted_) {
    stream_running_ = true;
    stream_bytes_left_ = 0;
    fill_stream();
  }
}

void FakeFirmware::arm_out(unsigned endpoint) {
  write(doeptsiz(endpoint), 1u << 19 | 64);
  set(doepctl(endpoint), epena | cnak);
}

void FakeFirmware::take_bulk(bool take) {
  bulk_taken_ = take;
  if (take && configuration != 0) arm_out(3);
}

void FakeFirmware::halt_bulk_in() { set(diepctl(2), stall); }

void FakeFirmware::send_report(std::span<const std::byte> report) {
  write(dieptsiz(1), 1u << 19 | static_cast<std::uint32_t>(report.size()));
  set(diepctl(1), epena | cnak);
  write_packet(1, report);
}

// Sends long transfers. The FIFO is refilled when it is half empty.
void FakeFirmware::fill_stream() {
  if (!stream_running_) return;
  if ((read(diepctl(2)) & epena) == 0) {
    constexpr std::uint32_t packets = 512;
    stream_bytes_left_ = packets * 64;
    write(dieptsiz(2), packets << 19 | stream_bytes_left_);
    set(diepctl(2), epena | cnak);
    set(diepempmsk, 1u << 2);
  }
  while (stream_bytes_left_ > 0 && read(dtxfsts(2)) >= 16) {
    for (int i = 0; i < 16; ++i) write(fifo(2), stream_word_++);
    stream_bytes_left_ -= 64;
  }
  if (stream_bytes_left_ == 0) write(diepempmsk, 0);
}

void FakeFirmware::write_packet(unsigned endpoint, std::span<const std::byte> data) {
  for (std::size_t i = 0; i < data.size(); i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, data.data() + i, std::min<std::size_t>(4, data.size() - i));
    write(fifo(endpoint), word);
  }
}

}  // namespace inkwell::virtual_usb_test
