// Events and transfers of the OTG_FS core (RM0090, "Device programming model").
#include "firmware/drivers/otg_fs/otg_fs.hpp"

#include <algorithm>
#include <cstring>

#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/registers/peripherals.hpp"

#include "firmware/drivers/otg_fs/core.hpp"
#include "firmware/drivers/otg_fs/fifo_memory.hpp"

namespace inkwell::drivers {

namespace {

using Fifo = RegistersOf<OtgFs, registers::OTG_FS_FIFO>;
using usb::Event;
using usb::packet_size_maximum;

constexpr unsigned number_of(std::uint8_t endpoint_address) { return endpoint_address & 0x0Fu; }
constexpr bool is_in(std::uint8_t endpoint_address) { return (endpoint_address & 0x80u) != 0; }
constexpr std::size_t words_for(std::size_t bytes) { return (bytes + 3) / 4; }

/// PKTSTS values of words in the receive FIFO.
enum PacketStatus : std::uint32_t { out_data = 2, out_done = 3, setup_done = 4, setup_data = 6 };

/// No other access to the core may occur between the words of a packet. In tests, an access between two words corrupted
/// the packet and its endpoint. No interrupt handler accesses the core.
void write_packet(unsigned endpoint, std::span<const std::byte> packet) {
  const std::byte* from = packet.data();
  std::size_t left = packet.size();
  for (; left >= 4; left -= 4, from += 4) {
    std::uint32_t word;
    std::memcpy(&word, from, 4);
    Fifo::DFIFO::write(endpoint, word);
  }
  if (left != 0) {
    std::uint32_t word = 0;
    std::memcpy(&word, from, left);
    Fifo::DFIFO::write(endpoint, word);
  }
}

/// Reads a packet of `size` bytes from the receive FIFO into `target`. If `target` is shorter than the packet, the
/// remaining bytes are discarded.
void read_packet(std::span<std::byte> target, std::size_t size) {
  for (std::size_t i = 0; i < size; i += 4) {
    const std::uint32_t word = Fifo::DFIFO::read(0);
    if (i >= target.size()) continue;
    std::memcpy(target.data() + i, &word, std::min<std::size_t>({4, size - i, target.size() - i}));
  }
}

/// A transfer may complete between the read and the write of the endpoint's control register. If EPENA were read as one
/// and written back, the write would start another transfer.
template <class Control, class... Fields>
void change(unsigned endpoint, Fields... fields) {
  Control::modify(endpoint, typename Control::EPENA(0), fields...);
}

/// Prepares endpoint 0 for three consecutive SETUP packets and one OUT packet.
void write_control_out_size() {
  using Size = Device::DOEPTSIZ;
  Size::write(0, Size::STUPCNT(3), Size::PKTCNT(1), Size::XFRSIZ(packet_size_maximum));
}

}  // namespace

// ---- events ------------------------------------------------------------------------------------------

bool OtgFs::next_event(Event& event) {
  follow_cable();
  if (Core::GINTSTS::USBRST::is_set()) {
    bus_reset();
    event.kind = Event::Kind::reset;
    event.length = 0;
    return true;
  }
  // The end of a bus reset (ENUMDNE) needs no action. After a reset, the core accepts packets of 64 bytes on endpoint
  // 0. The host continues a request after it has received the sent packet, so sent packets are reported first.
  if (next_sent(event) || next_received(event) || next_suspend_or_resume(event)) return true;
  answer_control();
  return false;
}

// A self-powered device pulls D+ up only while VBUS is present (USB 2.0, section 7.1.5).
void OtgFs::follow_cable() {
  const bool plugged = UsbSupply::is_high();
  if (plugged == pulled_up_) return;
  pulled_up_ = plugged;
  Device::DCTL::modify(Device::DCTL::SDIS(plugged ? 0 : 1));
}

// On a bus reset the core deactivates the endpoints (USBAEP). After a bus reset, endpoints are still enabled (EPENA),
// and old packets may be in the receive FIFO. The function begin_receive() supports OUT endpoints that are enabled with
// NAK set.
void OtgFs::bus_reset() {
  Core::GINTSTS::write(Core::GINTSTS::USBRST(1));
  for (unsigned i = 0; i < Device::DOEPCTL::count; ++i) change<Device::DOEPCTL>(i, Device::DOEPCTL::SNAK(1));
  for (unsigned i = 0; i < in_endpoints; ++i) stop_in(i);
  empty_receive_fifo();
  fifo_memory::lay_out();
  fifo_memory::flush_transmit(fifo_memory::all_transmit_fifos);
  control_receive_waits_ = control_stall_waits_ = false;
  setup_waits_ = setup_done_is_lost_ = false;
  suspended_ = false;
  frame_clock_.forget();
  set_address(0);
  write_control_out_size();
}

bool OtgFs::next_sent(Event& event) {
  for (unsigned i = 0; i < in_endpoints; ++i) {
    if (!in_[i].running || (i == 0 && control_send_waits_)) continue;
    if (Device::DIEPINT::XFRC::from(Device::DIEPINT::read(i))) {
      Device::DIEPINT::write(i, Device::DIEPINT::XFRC(1));
      in_[i].running = false;
      event.kind = Event::Kind::sent;
      event.endpoint = static_cast<std::uint8_t>(i);
      event.length = 0;
      return true;
    }
    fill(i);
  }
  return false;
}

bool OtgFs::next_received(Event& event) {
  // The FIFO contains at most three SETUP packets with their setup-done word, and an OUT packet with its out-done word.
  constexpr int words_at_once = 8;
  for (int i = 0; i < words_at_once && Core::GINTSTS::RXFLVL::is_set(); ++i)
    if (take_received_word(event)) return true;
  return false;
}

bool OtgFs::take_received_word(Event& event) {
  const std::uint32_t status = Core::GRXSTSP::read();
  const std::uint32_t endpoint = Core::GRXSTSP::EPNUM::from(status);
  const std::size_t size = Core::GRXSTSP::BCNT::from(status);
  event.endpoint = static_cast<std::uint8_t>(endpoint);
  switch (Core::GRXSTSP::PKTSTS::from(status)) {
    case setup_data:
      read_packet(setup_, size);
      setup_waits_ = true;
      if (!setup_done_is_lost_) return false;
      pass_on_setup(event);
      return true;
    case setup_done:
      // After the setup-done word, NAK may be cleared again.
      if (!setup_waits_) return false;
      pass_on_setup(event);
      return true;
    case out_data:
      if (endpoint >= out_endpoints) {  // the core was observed to report nonexistent endpoints
        read_packet({}, size);
        return false;
      }
      read_packet(out_[endpoint].data, size);
      out_[endpoint].length = static_cast<std::uint8_t>(std::min(size, packet_size_maximum));
      return false;
    case out_done:
      if (endpoint >= out_endpoints) return false;
      event.kind = Event::Kind::received;
      event.length = out_[endpoint].length;
      event.data = out_[endpoint].data;
      return true;
    default: return false;
  }
}

void OtgFs::pass_on_setup(Event& event) {
  write_control_out_size();
  control_receive_waits_ = control_stall_waits_ = false;
  setup_waits_ = setup_done_is_lost_ = false;
  event.kind = Event::Kind::setup;
  event.endpoint = 0;
  event.length = static_cast<std::uint8_t>(setup_.size());
  std::copy(setup_.begin(), setup_.end(), event.data.begin());
}

// An unplugged cable is handled like a silent bus.
bool OtgFs::next_suspend_or_resume(Event& event) {
  const bool silent = !pulled_up_ || Device::DSTS::SUSPSTS::is_set();
  if (silent == suspended_) return false;
  suspended_ = silent;
  if (silent) frame_clock_.forget();
  event.kind = silent ? Event::Kind::suspend : Event::Kind::resume;
  event.length = 0;
  return true;
}

// ---- transfers ---------------------------------------------------------------------------------------

// The field DAD may read back incorrectly, so the whole register is written.
void OtgFs::set_address(std::uint8_t address) {
  constexpr std::uint32_t full_speed_internal_phy = 3;
  Device::DCFG::write(Device::DCFG::DSPD(full_speed_internal_phy), Device::DCFG::DAD(address));
}

void OtgFs::send(std::uint8_t endpoint_address, std::span<const std::byte> data) {
  const unsigned endpoint = number_of(endpoint_address);
  in_[endpoint] = {data, true};
  if (endpoint == 0) {
    control_send_waits_ = true;
    answer_control();
  } else {
    begin_send(endpoint);
    fill(endpoint);
  }
}

void OtgFs::receive(std::uint8_t endpoint_address) {
  const unsigned endpoint = number_of(endpoint_address);
  if (endpoint == 0) {
    control_receive_waits_ = true;
    answer_control();
  } else {
    begin_receive(endpoint);
  }
}

// A SETUP packet invalidates the pending answer. Endpoint 0 is not changed until the end of the SETUP stage. If NAK is
// cleared before the setup-done word is read, this word is lost. Any word in the receive FIFO may belong to a SETUP
// packet.
void OtgFs::answer_control() {
  const bool sends = control_send_waits_;
  if ((sends || control_receive_waits_ || control_stall_waits_) && arm_control() && sends) fill(0);
}

// If a SETUP packet arrives between the check of the receive FIFO and the write that clears NAK, the write opens the
// endpoint for the wrong request. Interrupts are disabled to keep the time between check and write short. A second
// check detects a packet that arrived between the first check and the write. NAK is set again within 4 us after the
// SETUP packet, before the host's next token ends.
//
// Each SETUP packet sets NAK. NAK therefore shows whether the packet arrived before or after the write. A write after
// the arrival of the packet removes the setup-done word. If the packet arrives after the write, the core reports the
// setup-done word.
bool OtgFs::arm_control() {
  const InterruptsHeld held;
  const bool receives = control_receive_waits_;
  if (setup_waits_ || Core::GINTSTS::RXFLVL::is_set()) return false;
  if (receives) begin_receive(0);
  if (control_send_waits_) begin_send(0);
  if (control_stall_waits_) {
    change<Device::DIEPCTL>(0, Device::DIEPCTL::STALL(1));
    change<Device::DOEPCTL>(0, Device::DOEPCTL::STALL(1));
  }
  control_receive_waits_ = control_send_waits_ = control_stall_waits_ = false;
  using Waiting = Core::GRXSTSR;
  if (!Core::GINTSTS::RXFLVL::is_set()) return true;
  const std::uint32_t waiting = Waiting::read();
  if (Waiting::PKTSTS::from(waiting) != setup_data || Waiting::EPNUM::from(waiting) != 0) return true;
  setup_done_is_lost_ = receives && !Device::DOEPCTL::NAKSTS::from(Device::DOEPCTL::read(0));
  change<Device::DIEPCTL>(0, Device::DIEPCTL::SNAK(1));
  change<Device::DOEPCTL>(0, Device::DOEPCTL::SNAK(1));
  return false;
}

void OtgFs::begin_send(unsigned endpoint) {
  using Size = Device::DIEPTSIZ;
  const auto size = static_cast<std::uint32_t>(in_[endpoint].remaining.size());
  const std::uint32_t packets = size == 0 ? 1 : (size + packet_size_maximum - 1) / packet_size_maximum;
  Size::write(endpoint, Size::PKTCNT(packets), Size::XFRSIZ(size));
  Device::DIEPCTL::modify(endpoint, Device::DIEPCTL::EPENA(1), Device::DIEPCTL::CNAK(1));
}

void OtgFs::fill(unsigned endpoint) {
  std::span<const std::byte>& remaining = in_[endpoint].remaining;
  while (!remaining.empty()) {
    const std::size_t size = std::min(remaining.size(), packet_size_maximum);
    if (Device::DTXFSTS::INEPTFSAV::from(Device::DTXFSTS::read(endpoint)) < words_for(size)) return;
    write_packet(endpoint, remaining.first(size));
    remaining = remaining.subspan(size);
  }
}

void OtgFs::begin_receive(unsigned endpoint) {
  using Control = Device::DOEPCTL;
  using Size = Device::DOEPTSIZ;
  if (endpoint == 0) {
    write_control_out_size();
  } else if (!Control::EPENA::from(Control::read(endpoint))) {
    Size::write(endpoint, Size::PKTCNT(1), Size::XFRSIZ(packet_size_maximum));
  } else if (Size::PKTCNT::from(Size::read(endpoint)) == 0) {
    return;  // the packet is in the receive FIFO; receive() is called again after the packet has been read
  }
  // The size register keeps its value if the endpoint is stalled or reopened.
  Control::modify(endpoint, Control::EPENA(1), Control::CNAK(1));
}

bool OtgFs::cancel(std::uint8_t endpoint_address) { return stop_in(number_of(endpoint_address)); }

// The caller has set NAK on every OUT endpoint. The function completes the OUT transfers and discards the received
// packets.
void OtgFs::empty_receive_fifo() {
  for (std::size_t i = 0; i < fifo_memory::receive_words && Core::GINTSTS::RXFLVL::is_set(); ++i)
    read_packet({}, Core::GRXSTSP::BCNT::read());
}

bool OtgFs::stop_in(unsigned endpoint) {
  using Control = Device::DIEPCTL;
  using Flags = Device::DIEPINT;
  if (!in_[endpoint].running) return false;
  in_[endpoint] = {};
  if (endpoint == 0 && control_send_waits_) {
    control_send_waits_ = false;
    return true;
  }
  bool was_left = false;
  if (Control::EPENA::from(Control::read(endpoint))) {
    change<Control>(endpoint, Control::SNAK(1));
    static_cast<void>(wait_for(core_answer_cycles, [=] { return Flags::INEPNE::from(Flags::read(endpoint)) != 0; }));
    // A packet in progress may have completed the transfer. An endpoint that is already disabled does not set EPDISD.
    was_left = Control::EPENA::from(Control::read(endpoint)) != 0;
    if (was_left) {
      Control::modify(endpoint, Control::SNAK(1), Control::EPDIS(1));
      static_cast<void>(wait_for(core_answer_cycles, [=] { return Flags::EPDISD::from(Flags::read(endpoint)) != 0; }));
    }
  }
  fifo_memory::flush_transmit(endpoint);
  // INEPNE is cleared when NAK is cleared again.
  Flags::write(endpoint, Flags::XFRC(1), Flags::EPDISD(1));
  return was_left;
}

// ---- endpoints ---------------------------------------------------------------------------------------

void OtgFs::open(std::uint8_t endpoint_address, usb::EndpointType type) {
  const unsigned endpoint = number_of(endpoint_address);
  if (is_in(endpoint_address)) {
    using Control = Device::DIEPCTL;
    stop_in(endpoint);
    Control::write(endpoint, Control::MPSIZ(packet_size_maximum), Control::USBAEP(1),
                   Control::EPTYP(static_cast<std::uint32_t>(type)), Control::TXFNUM(endpoint), Control::SD0PID(1));
  } else {
    using Control = Device::DOEPCTL;
    Control::write(endpoint, Control::MPSIZ(packet_size_maximum), Control::USBAEP(1),
                   Control::EPTYP(static_cast<std::uint32_t>(type)), Control::SD0PID(1));
  }
}

void OtgFs::close(std::uint8_t endpoint_address) {
  const unsigned endpoint = number_of(endpoint_address);
  if (is_in(endpoint_address)) {
    stop_in(endpoint);
    change<Device::DIEPCTL>(endpoint, Device::DIEPCTL::USBAEP(0));
  } else {
    change<Device::DOEPCTL>(endpoint, Device::DOEPCTL::USBAEP(0));
  }
}

void OtgFs::stall(std::uint8_t endpoint_address) {
  const unsigned endpoint = number_of(endpoint_address);
  if (endpoint == 0) {
    stop_in(0);
    control_receive_waits_ = false;
    control_stall_waits_ = true;
    answer_control();
  } else if (is_in(endpoint_address)) {
    stop_in(endpoint);
    change<Device::DIEPCTL>(endpoint, Device::DIEPCTL::STALL(1));
  } else {
    change<Device::DOEPCTL>(endpoint, Device::DOEPCTL::STALL(1));
  }
}

void OtgFs::clear_stall(std::uint8_t endpoint_address) {
  const unsigned endpoint = number_of(endpoint_address);
  if (is_in(endpoint_address)) {
    stop_in(endpoint);
    change<Device::DIEPCTL>(endpoint, Device::DIEPCTL::STALL(0), Device::DIEPCTL::SD0PID(1));
  } else {
    change<Device::DOEPCTL>(endpoint, Device::DOEPCTL::STALL(0), Device::DOEPCTL::SD0PID(1));
  }
}

}  // namespace inkwell::drivers
