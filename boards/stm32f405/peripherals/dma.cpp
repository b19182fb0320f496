#include "boards/stm32f405/peripherals/dma.hpp"

#include <algorithm>
#include <cstring>

namespace inkwell::virtual_board {
namespace {

/// The flags of every stream are stored at the LISR bit positions of stream 0.
constexpr std::uint32_t transfer_error = dma.lisr.teif.mask(), half = dma.lisr.htif.mask(),
                        complete = dma.lisr.tcif.mask();
constexpr std::uint32_t all_flags = dma.lisr.feif.mask() | dma.lisr.dmeif.mask() | transfer_error | half | complete;
/// First flag bit of each stream in LISR or HISR.
constexpr unsigned flag_shift[4] = {dma.lisr.feif.position(0), dma.lisr.feif.position(1),
                                    dma.lisr.feif_upper.position(0), dma.lisr.feif_upper.position(1)};
constexpr std::uint32_t first_stream = dma.cr, stream_bytes = dma.cr.stride;
constexpr std::uint32_t fifo_is_empty = 4;  // FCR.FS: requests are transferred immediately

struct Request {
  std::uint8_t peripheral, source, controller, stream, channel;
};
constexpr Request timer_requests[] = {
    {1, 0, 2, 5, 6}, {1, 1, 2, 1, 6}, {1, 1, 2, 3, 6}, {1, 2, 2, 2, 6}, {1, 3, 2, 6, 6}, {1, 4, 2, 4, 6},
    {1, 1, 2, 6, 0}, {1, 2, 2, 6, 0}, {1, 3, 2, 6, 0}, {2, 0, 1, 1, 3}, {2, 3, 1, 1, 3}, {2, 1, 1, 5, 3},
    {2, 2, 1, 6, 3}, {2, 4, 1, 6, 3}, {2, 0, 1, 7, 3}, {2, 4, 1, 7, 3}, {3, 0, 1, 2, 5}, {3, 4, 1, 2, 5},
    {3, 1, 1, 4, 5}, {3, 2, 1, 5, 5}, {3, 3, 1, 7, 5}, {4, 1, 1, 0, 2}, {4, 2, 1, 3, 2}, {4, 0, 1, 6, 2},
    {4, 3, 1, 7, 2}, {5, 3, 1, 0, 6}, {5, 0, 1, 0, 6}, {5, 4, 1, 1, 6}, {5, 1, 1, 2, 6}, {5, 4, 1, 3, 6},
    {5, 2, 1, 4, 6}, {5, 0, 1, 6, 6}, {6, 0, 1, 1, 7}, {7, 0, 1, 2, 1}, {7, 0, 1, 4, 1}, {8, 0, 2, 1, 7},
    {8, 1, 2, 2, 7}, {8, 2, 2, 3, 7}, {8, 3, 2, 4, 7}, {8, 4, 2, 7, 7}, {8, 1, 2, 2, 0}, {8, 2, 2, 2, 0},
    {8, 3, 2, 2, 0},
};
constexpr Request adc_requests[] = {{0, 0, 2, 0, 0}, {0, 0, 2, 4, 0}, {1, 0, 2, 2, 1},
                                    {1, 0, 2, 3, 1}, {2, 0, 2, 0, 2}, {2, 0, 2, 1, 2}};
// `source` is 0 for reception and 1 for transmission.
constexpr Request usart_requests[] = {
    {1, 0, 2, 2, 4}, {1, 0, 2, 5, 4}, {1, 1, 2, 7, 4}, {2, 0, 1, 5, 4}, {2, 1, 1, 6, 4}, {3, 0, 1, 1, 4},
    {3, 1, 1, 3, 4}, {3, 1, 1, 4, 7}, {4, 0, 1, 2, 4}, {4, 1, 1, 4, 4}, {5, 0, 1, 0, 4}, {5, 1, 1, 7, 4},
    {6, 0, 2, 1, 5}, {6, 0, 2, 2, 5}, {6, 1, 2, 6, 5}, {6, 1, 2, 7, 5},
};

constexpr Request spi_requests[] = {
    {1, 0, 2, 0, 3}, {1, 0, 2, 2, 3}, {1, 1, 2, 3, 3}, {1, 1, 2, 5, 3}, {2, 0, 1, 3, 0},
    {2, 1, 1, 4, 0}, {3, 0, 1, 0, 0}, {3, 0, 1, 2, 0}, {3, 1, 1, 5, 0}, {3, 1, 1, 7, 0},
};

constexpr unsigned position_of(unsigned number, unsigned stream) {
  constexpr unsigned positions[2][8] = {{11, 12, 13, 14, 15, 16, 17, 47}, {56, 57, 58, 59, 60, 68, 69, 70}};
  return positions[number - 1][stream];
}

template <std::size_t n>
bool request_stream(Dma& controllers, const Request (&requests)[n], unsigned peripheral, unsigned source) {
  for (const auto& r : requests)
    if (r.peripheral == peripheral && r.source == source &&
        controllers.controller(r.controller).request(r.stream, r.channel))
      return true;
  return false;
}

}  // namespace

DmaController::DmaController(Machine& machine, Bus& bus, DmaUsers& users, unsigned number)
    : machine_(machine), bus_(bus), users_(users), number_(number) {}

void DmaController::reset() {
  streams_ = {};
  for (unsigned i = 0; i < 8; ++i) update_interrupt(i);
}

void DmaController::update_interrupt(unsigned index) {
  const auto& s = streams_[index];
  machine_.nvic.set_source(position_of(number_, index), 0,
                           (dma.cr.tcie.in(s.control) && (s.flags & complete) != 0) ||
                               (dma.cr.htie.in(s.control) && (s.flags & half) != 0) ||
                               (dma.cr.teie.in(s.control) && (s.flags & transfer_error) != 0));
}

bool DmaController::load(std::uint32_t address, unsigned size, std::uint32_t& value) {
  value = 0;
  if (address >= 0x4000'0000) {
    value = bus_.read_register(address, size);
    return true;
  }
  const std::uint8_t* memory = machine_.memory.at(address, size);
  // DMA cannot access the CCM, because the CCM is connected only to the processor's data bus (RM0090, "System
  // architecture").
  if (memory == nullptr || (address >= ccm_base && address < system_base)) return false;
  std::memcpy(&value, memory, size);
  return true;
}

bool DmaController::store(std::uint32_t address, unsigned size, std::uint32_t value) {
  if (address >= 0x4000'0000) {
    bus_.write_register(address, value, size);
    return true;
  }
  std::uint8_t* memory = machine_.memory.ram_at(address, size);
  if (memory == nullptr || address < sram_base) return false;
  std::memcpy(memory, &value, size);
  machine_.on_ram_write(address, size);
  return true;
}

void DmaController::move_item(unsigned index) {
  auto& s = streams_[index];
  const unsigned size = 1u << dma.cr.psize.of(s.control);
  const unsigned target = dma.cr.ct.of(s.control);
  const std::uint32_t peripheral = s.peripheral + (dma.cr.pinc.in(s.control) ? s.moved * size : 0);
  const std::uint32_t memory = s.memory[target] + (dma.cr.minc.in(s.control) ? s.moved * size : 0);
  std::uint32_t value = 0;
  const bool moved = dma.cr.dir.of(s.control) == memory_to_peripheral
                         ? load(memory, size, value) && store(peripheral, size, value)
                         : load(peripheral, size, value) && store(memory, size, value);
  if (!moved) {
    s.control &= ~dma.cr.en.mask();
    s.flags |= transfer_error;
    return update_interrupt(index);
  }
  ++s.moved;
  --s.count;
  if (s.count == s.reload / 2) s.flags |= half;
  if (s.count == 0) {
    s.flags |= complete;
    if (dma.cr.dbm.in(s.control)) s.control ^= dma.cr.ct.mask();
    if (dma.cr.circ.in(s.control) || dma.cr.dbm.in(s.control)) {
      s.count = s.reload;
      s.moved = 0;
    } else {
      s.control &= ~dma.cr.en.mask();
    }
  }
  update_interrupt(index);
}

bool DmaController::request(unsigned index, unsigned channel) {
  const auto& s = streams_[index];
  if (stopped_ || !dma.cr.en.in(s.control) || dma.cr.chsel.of(s.control) != channel || s.count == 0) return false;
  move_item(index);
  return true;
}

void DmaController::enable(unsigned index) {
  auto& s = streams_[index];
  if (s.flags != 0)
    machine_.violations.violate(Rule::stream_flags_left,
                                "DMA" + std::to_string(number_) + " stream " + std::to_string(index));
  s.reload = s.count;
  s.moved = 0;
  if (dma.cr.dir.of(s.control) == memory_to_memory) {
    if (number_ == 1) return machine_.violations.violate(Rule::copy_by_first_controller);
    while (dma.cr.en.in(s.control) && s.count != 0) move_item(index);
  } else {
    users_.serve_dma();  // a peripheral request may be pending
  }
}

std::uint32_t DmaController::stored(std::uint32_t offset) const {
  if (offset < first_stream || offset >= first_stream + 8 * stream_bytes) return 0;
  const auto& s = streams_[(offset - first_stream) / stream_bytes];
  switch (first_stream + (offset - first_stream) % stream_bytes) {
    case dma.cr: return s.control;
    case dma.ndtr: return s.count;
    case dma.par: return s.peripheral;
    case dma.m0ar: return s.memory[0];
    case dma.m1ar: return s.memory[1];
    default: return s.fifo;
  }
}

std::uint32_t DmaController::read_word(std::uint32_t offset) {
  if (offset == dma.lisr || offset == dma.hisr) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= streams_[offset + i].flags << flag_shift[i];
    return value;
  }
  if (offset >= first_stream + 8 * stream_bytes) machine_.log.note("DMA" + std::to_string(number_), offset, false, 0);
  return stored(offset);
}

void DmaController::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset == dma.lifcr || offset == dma.hifcr) {
    for (unsigned i = 0; i < 4; ++i) {
      const unsigned index = offset - dma.lifcr + i;
      streams_[index].flags &= ~(value >> flag_shift[i] & all_flags);
      update_interrupt(index);
    }
    return;
  }
  if (offset < first_stream || offset >= first_stream + 8 * stream_bytes)
    return machine_.log.note("DMA" + std::to_string(number_), offset, true, value);
  const unsigned index = (offset - first_stream) / stream_bytes;
  auto& s = streams_[index];
  switch (first_stream + (offset - first_stream) % stream_bytes) {
    case dma.cr: {
      const bool was_enabled = dma.cr.en.in(s.control), is_enabled = dma.cr.en.in(value);
      s.control = value & writable(dma.cr);
      if (was_enabled && !is_enabled) s.flags |= complete;
      if (!was_enabled && is_enabled) enable(index);
      return update_interrupt(index);
    }
    case dma.ndtr:
      if (!dma.cr.en.in(s.control)) s.count = dma.ndtr.ndt.of(value);
      return;
    case dma.par: s.peripheral = value; return;
    case dma.m0ar: s.memory[0] = value; return;
    case dma.m1ar: s.memory[1] = value; return;
    default: s.fifo = (value & writable(dma.fcr)) | dma.fcr.fs.with(fifo_is_empty); return;
  }
}

Dma::Dma(Machine& machine, Bus& bus, DmaUsers& users)
    : first_(machine, bus, users, 1), second_(machine, bus, users, 2) {}

bool Dma::adc_request(unsigned index) { return request_stream(*this, adc_requests, index, 0); }
bool Dma::interrupts_for_adc(unsigned index) const {
  return std::ranges::any_of(adc_requests, [&](const Request& r) {
    return r.peripheral == index && (r.controller == 1 ? first_ : second_).interrupts_for(r.stream, r.channel);
  });
}
bool Dma::timer_request(unsigned timer, unsigned source) {
  return request_stream(*this, timer_requests, timer, source);
}
bool Dma::spi_request(unsigned number, bool transmit) {
  return request_stream(*this, spi_requests, number, transmit ? 1 : 0);
}
bool Dma::usart_request(unsigned number, bool transmit) {
  return request_stream(*this, usart_requests, number, transmit ? 1 : 0);
}

}  // namespace inkwell::virtual_board
