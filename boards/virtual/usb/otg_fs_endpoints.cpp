// The OTG_FS core towards the processor: endpoint registers and the FIFO windows.
#include <algorithm>

#include <virtual_usb/otg_fs_device.hpp>

#include "otg_fs_registers.hpp"

namespace inkwell::virtual_board {

using namespace otg;

namespace {
constexpr std::uint32_t stored_bits(bool is_in, unsigned endpoint) {
  const std::uint32_t common = epctl::mpsiz | (is_in ? epctl::txfnum : epctl::snpm);
  return endpoint == 0 ? common : common | epctl::usbaep | epctl::type_bits;
}
}  // namespace

// --- IN: towards the host ---------------------------------------------------------------------------------

std::uint32_t OtgFsDevice::read_in_endpoint(std::uint32_t offset) {
  const unsigned number = offset / offset::endpoint_bytes;
  const InEndpoint& endpoint = in_[number];
  switch (offset % offset::endpoint_bytes) {
    case offset::control: return endpoint.control | (number != 0 && endpoint.data1 ? epctl::dpid : 0);
    case offset::interrupts: return in_interrupts(number);
    case offset::transfer_size: return (endpoint.packets << 19) | endpoint.bytes_to_load;
    case offset::fifo_status: return static_cast<std::uint32_t>(transmit_words_free(number));
    default: log_.note("OTG_FS", offset::in_endpoints + offset, false, 0); return 0;
  }
}

void OtgFsDevice::write_in_endpoint(std::uint32_t offset, std::uint32_t value) {
  const unsigned number = offset / offset::endpoint_bytes;
  InEndpoint& endpoint = in_[number];
  switch (offset % offset::endpoint_bytes) {
    case offset::control: write_in_control(number, value); break;
    case offset::interrupts: endpoint.interrupts &= ~value; break;
    case offset::transfer_size:
      if ((endpoint.control & epctl::epena) != 0 && (endpoint.control & epctl::naksts) == 0)
        rules_.violate(Rule::usb_size_while_enabled);
      endpoint.packets = tsiz::packets(value, number == 0);
      endpoint.bytes_to_load = endpoint.bytes_to_send = value & (number == 0 ? 0x7F : 0x7FFFF);
      endpoint.packet_words_to_load = 0;
      endpoint.bytes_on_wire.reset();
      break;
    default: log_.note("OTG_FS", offset::in_endpoints + offset, true, value); break;
  }
}

void OtgFsDevice::write_in_control(unsigned number, std::uint32_t value) {
  InEndpoint& endpoint = in_[number];
  const std::uint32_t stored = stored_bits(true, number);
  endpoint.control = (endpoint.control & ~stored) | (value & stored);
  if (number == 0)
    endpoint.control |= value & epctl::stall;  // firmware can only set it: a SETUP packet clears it
  else
    endpoint.control = (endpoint.control & ~epctl::stall) | (value & epctl::stall);
  if ((value & epctl::cnak) != 0) endpoint.control &= ~epctl::naksts;
  if ((value & epctl::snak) != 0) {
    endpoint.control |= epctl::naksts;
    endpoint.interrupts |= epint::inepne;
  }
  if (number != 0 && (value & epctl::sd0pid) != 0) endpoint.data1 = false;
  if (number != 0 && (value & epctl::sd1pid) != 0) endpoint.data1 = true;
  if ((value & epctl::epdis) != 0) {
    if ((endpoint.control & epctl::epena) != 0) {
      endpoint.control &= ~epctl::epena;
      endpoint.interrupts |= epint::epdisd;
      endpoint.bytes_on_wire.reset();
    } else {
      rules_.violate(Rule::usb_disable_without_enable);
    }
  } else if ((value & epctl::epena) != 0 && (endpoint.control & epctl::epena) == 0) {
    endpoint.control |= epctl::epena;
    check_in_transfer(number);
  }
}

void OtgFsDevice::check_in_transfer(unsigned number) {
  const InEndpoint& endpoint = in_[number];
  const std::uint32_t where = offset::in_endpoints + number * offset::endpoint_bytes;
  const unsigned maximum = in_packet_maximum(number);
  if (endpoint.packets == 0) rules_.violate(Rule::usb_no_packets, "IN " + std::to_string(number));
  if (endpoint.bytes_to_send > endpoint.packets * maximum) rules_.violate(Rule::usb_bytes_beyond_packets);
  if ((endpoint.control & epctl::usbaep) == 0 && !reset_is_unseen())
    rules_.violate(Rule::usb_inactive_endpoint, "IN " + std::to_string(number));
  if (epctl::type(endpoint.control) == epctl::isochronous && number != 0)
    note("isochronous endpoints are not modelled", where, true, endpoint.control);
  if (!transmit_[transmit_fifo_of(number)].empty()) rules_.violate(Rule::usb_stale_words);
  if (transmit_depth(transmit_fifo_of(number)) * 4 < std::min<std::size_t>(endpoint.bytes_to_send, maximum))
    rules_.violate(Rule::usb_fifo_too_small);
  note_memory_layout();
}

void OtgFsDevice::push_transmit_data(unsigned number, std::uint32_t word) {
  InEndpoint& endpoint = in_[number];
  const unsigned fifo_number = transmit_fifo_of(number);
  WordFifo& fifo = transmit_[fifo_number];

  if (endpoint.packet_words_to_load != 0 && writing_endpoint_ != number && !endpoint.damaged) {
    // Seen on silicon: the packet goes out with a bad CRC, again and again, until the FIFO is flushed.
    rules_.violate(Rule::usb_interleaved);
    endpoint.damaged = true;
  }
  writing_endpoint_ = number;
  if (fifo.count() >= transmit_depth(fifo_number)) {
    rules_.violate(Rule::usb_fifo_full);
    return;
  }
  if ((endpoint.control & epctl::epena) == 0) rules_.violate(Rule::usb_fifo_before_enable);

  const bool level_before = transmit_empty_level(number);
  fifo.push(word);
  if (endpoint.packet_words_to_load == 0) {
    endpoint.packet_bytes_loading = std::min<std::uint32_t>(endpoint.bytes_to_load, in_packet_maximum(number));
    endpoint.packet_words_to_load = words_for(endpoint.packet_bytes_loading);
    if (endpoint.packet_words_to_load == 0) {
      rules_.violate(Rule::usb_words_beyond_transfer);
      return;
    }
  }
  if (--endpoint.packet_words_to_load == 0) {
    endpoint.bytes_to_load -= endpoint.packet_bytes_loading;
    ++endpoint.packets_in_fifo;
    constexpr unsigned packets_that_the_core_counts = 8;
    if (endpoint.packets_in_fifo > packets_that_the_core_counts) {
      rules_.violate(Rule::usb_fifo_packets, "IN " + std::to_string(number));
      endpoint.damaged = true;
    }
  }
  if (level_before != transmit_empty_level(number)) update_interrupt();
}

void OtgFsDevice::flush_transmit(unsigned number) {
  transmit_[number].clear();
  for (unsigned i = 0; i < endpoint_count; ++i) {
    if (transmit_fifo_of(i) != number) continue;
    in_[i].packet_words_to_load = 0;
    in_[i].packets_in_fifo = 0;
    in_[i].damaged = false;
    in_[i].bytes_on_wire.reset();
  }
}

unsigned OtgFsDevice::in_packet_maximum(unsigned endpoint) const {
  const std::uint32_t field = in_[endpoint].control & epctl::mpsiz;
  return endpoint == 0 ? 64u >> (field & 3) : field;
}

unsigned OtgFsDevice::transmit_fifo_of(unsigned endpoint) const {
  const unsigned number = (in_[endpoint].control & epctl::txfnum) >> 22;
  return endpoint == 0 || number >= endpoint_count ? 0 : number;
}

std::size_t OtgFsDevice::transmit_depth(unsigned number) const {
  return std::min<std::size_t>(transmit_size_[number] >> 16, packet_memory_words);
}

std::size_t OtgFsDevice::transmit_words_free(unsigned endpoint) const {
  const unsigned fifo = transmit_fifo_of(endpoint);
  const std::size_t depth = transmit_depth(fifo);
  return depth - std::min(depth, transmit_[fifo].count());
}

bool OtgFsDevice::transmit_empty_level(unsigned endpoint) const {
  const unsigned fifo = transmit_fifo_of(endpoint);
  const std::size_t level = (bus_configuration_ & gahbcfg::txfelvl) != 0 ? 0 : transmit_depth(fifo) / 2;
  return transmit_[fifo].count() <= level;
}

// Regions must lie one after another in the packet memory; the core does not check, it overwrites.
void OtgFsDevice::note_memory_layout() {
  if (!layout_changed_) return;
  layout_changed_ = false;
  struct Region {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  std::array<Region, endpoint_count + 1> regions{};
  regions[0].end = receive_size_;
  for (unsigned i = 0; i < endpoint_count; ++i) {
    if (i != 0 && (in_[i].control & epctl::usbaep) == 0) continue;
    const std::uint32_t size_register = transmit_size_[transmit_fifo_of(i)];
    const std::size_t begin = size_register & 0xFFFF;
    regions[i + 1] = {begin, begin + (size_register >> 16)};
  }
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (regions[i].end > packet_memory_words) rules_.violate(Rule::usb_memory_exceeded);
    for (std::size_t j = 0; j < i; ++j)
      if (regions[i].begin < regions[j].end && regions[j].begin < regions[i].end)
        rules_.violate(Rule::usb_memory_overlap);
  }
}

// --- OUT: from the host -----------------------------------------------------------------------------------

std::uint32_t OtgFsDevice::read_out_endpoint(std::uint32_t offset) {
  const unsigned number = offset / offset::endpoint_bytes;
  const OutEndpoint& endpoint = out_[number];
  switch (offset % offset::endpoint_bytes) {
    case offset::control:
      if (number == 0) return endpoint.control | (in_[0].control & 3);  // one packet size for both directions
      return endpoint.control | (endpoint.data1 ? epctl::dpid : 0);
    case offset::interrupts: return endpoint.interrupts;
    case offset::transfer_size:
      return (endpoint.packets << 19) | endpoint.bytes | (number == 0 ? setup_packets_allowed_ << 29 : 0);
    default: log_.note("OTG_FS", offset::out_endpoints + offset, false, 0); return 0;
  }
}

void OtgFsDevice::write_out_endpoint(std::uint32_t offset, std::uint32_t value) {
  const unsigned number = offset / offset::endpoint_bytes;
  OutEndpoint& endpoint = out_[number];
  switch (offset % offset::endpoint_bytes) {
    case offset::control: write_out_control(number, value); break;
    case offset::interrupts: endpoint.interrupts &= ~value; break;
    case offset::transfer_size:
      endpoint.packets = number == 0 ? (value >> 19) & 1 : tsiz::packets(value, false);
      endpoint.bytes = value & (number == 0 ? 0x7F : 0x7FFFF);
      if (number == 0) setup_packets_allowed_ = (value >> 29) & 3;
      break;
    default: log_.note("OTG_FS", offset::out_endpoints + offset, true, value); break;
  }
}

void OtgFsDevice::write_out_control(unsigned number, std::uint32_t value) {
  OutEndpoint& endpoint = out_[number];
  const std::uint32_t stored = stored_bits(false, number);
  endpoint.control = (endpoint.control & ~stored) | (value & stored);
  if (number == 0)
    endpoint.control |= value & epctl::stall;
  else
    endpoint.control = (endpoint.control & ~epctl::stall) | (value & epctl::stall);
  if ((value & epctl::cnak) != 0) {
    if (number == 0) lose_setup_done_word();
    endpoint.control &= ~epctl::naksts;
  }
  if ((value & epctl::snak) != 0) endpoint.control |= epctl::naksts;
  if (number != 0 && (value & epctl::sd0pid) != 0) endpoint.data1 = false;
  if (number != 0 && (value & epctl::sd1pid) != 0) endpoint.data1 = true;
  if ((value & epctl::epdis) != 0) {
    if (number == 0 || (endpoint.control & epctl::epena) == 0) {
      rules_.violate(Rule::usb_out_disable);
    } else if (global_out_nak_effective_) {
      disable_out(endpoint);
    } else {
      rules_.violate(Rule::usb_out_disable_early);
      endpoint.disable_pending = true;
    }
  } else if (((value & epctl::epena) != 0 || armed_by_cnak(number, value)) && (endpoint.control & epctl::epena) == 0) {
    endpoint.control |= epctl::epena;
    check_out_transfer(number);
  }
}

// The manual asks for EPENA and CNAK together, but drivers in the field, ChibiOS's among them, start an OUT transfer
// with CNAK alone, and silicon takes its packets.
bool OtgFsDevice::armed_by_cnak(unsigned number, std::uint32_t control_written) const {
  const OutEndpoint& endpoint = out_[number];
  const bool clears_nak = (control_written & (epctl::cnak | epctl::snak)) == epctl::cnak;
  return clears_nak && (number == 0 || ((endpoint.control & epctl::usbaep) != 0 && endpoint.packets != 0));
}

void OtgFsDevice::check_out_transfer(unsigned number) {
  const OutEndpoint& endpoint = out_[number];
  const std::uint32_t where = offset::out_endpoints + number * offset::endpoint_bytes;
  if (endpoint.packets == 0 && number != 0) rules_.violate(Rule::usb_no_packets, "OUT " + std::to_string(number));
  if (number == 0) return;
  const std::uint32_t maximum = endpoint.control & epctl::mpsiz;
  if (maximum == 0 || endpoint.bytes == 0 || endpoint.bytes % maximum != 0) rules_.violate(Rule::usb_out_size);
  if ((endpoint.control & epctl::usbaep) == 0 && !reset_is_unseen())
    rules_.violate(Rule::usb_inactive_endpoint, "OUT " + std::to_string(number));
  if (epctl::type(endpoint.control) == epctl::isochronous)
    note("isochronous endpoints are not modelled", where, true, endpoint.control);
}

void OtgFsDevice::disable_out(OutEndpoint& endpoint) {
  endpoint.disable_pending = false;
  endpoint.control &= ~epctl::epena;
  endpoint.interrupts |= epint::epdisd;
}

// Seen on silicon: clearing NAK on endpoint 0 between a SETUP packet and the pop of its setup-done word
// loses that word.
void OtgFsDevice::lose_setup_done_word() {
  if (!setup_done_unpopped_ || setup_done_lost_) return;
  rules_.violate(Rule::usb_nak_cleared_early);
  setup_done_lost_ = true;
}

std::uint32_t OtgFsDevice::pop_receive_status() {
  if (receive_.empty()) {
    rules_.violate(Rule::usb_pop_empty);
    return 0;
  }
  if (receive_data_words_ != 0) {
    rules_.violate(Rule::usb_pop_before_data);
    --receive_data_words_;
    const std::uint32_t word = receive_.pop();
    update_interrupt();
    return word;
  }
  const std::uint32_t word = receive_.pop();
  const unsigned number = pktsts::endpoint(word);
  switch (pktsts::of(word)) {
    case pktsts::global_out_nak:
      global_out_nak_effective_ = global_out_nak_asked_;
      if (global_out_nak_effective_)
        for (OutEndpoint& endpoint : out_)
          if (endpoint.disable_pending) disable_out(endpoint);
      break;
    case pktsts::out_data:
    case pktsts::setup_data: receive_data_words_ = words_for(pktsts::bytes(word)); break;
    case pktsts::out_done: out_[number].interrupts |= epint::xfrc; break;
    case pktsts::setup_done:
      setup_done_unpopped_ = false;
      if (setup_done_lost_) {
        setup_done_lost_ = false;
        update_interrupt();
        return receive_.empty() ? 0 : pop_receive_status();
      }
      out_[0].interrupts |= epint::stup;
      break;
    default: break;
  }
  update_interrupt();
  return word;
}

std::uint32_t OtgFsDevice::pop_receive_data() {
  if (receive_data_words_ == 0) {
    rules_.violate(Rule::usb_read_beyond_packet);
    return 0;
  }
  --receive_data_words_;
  const std::uint32_t word = receive_.pop();
  if (receive_.empty()) update_interrupt();
  return word;
}

}  // namespace inkwell::virtual_board
