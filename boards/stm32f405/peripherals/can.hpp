// CAN1 and CAN2 on a bus without other nodes (RM0090, "Controller area network"). Mode changes work. Because no node
// acknowledges a frame, the error counter rises until the controller is error passive. In loop-back mode the controller
// receives its own frames through the filters.
#pragma once

#include <utility>

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/can_map.hpp"
#include "boards/stm32f405/peripherals/can_reception.hpp"

namespace inkwell::virtual_board {

class Can final : public RegisterBlock, public Freezable {
 public:
  /// A controller has four consecutive interrupt vectors. The last vector is for errors and mode changes. CAN2 uses the
  /// filters of CAN1 (`first`).
  Can(Machine& machine, Scheduler& events, unsigned number, unsigned first_position, const Can* first = nullptr)
      : machine_(machine),
        events_(events),
        number_(number),
        first_position_(first_position),
        filters_(first != nullptr ? first->own_filters_ : own_filters_) {
    constexpr unsigned first_stop_bit = 25;  // DBG_CAN1_STOP
    machine.debug_halt.add(*this, DebugHalt::apb1, first_stop_bit + number - 1);
  }
  /// Freezes the bus only if CAN_MCR.DBF is set. An interrupted frame restarts.
  void freeze(bool frozen) override {
    frozen_ = frozen && can.mcr.dbf.in(word(can.mcr));
    if (frozen_ && sending_ != 0) events_.cancel(std::exchange(sending_, 0));
    send();
  }
  void reset() override {
    words_ = {};
    for (const auto& one : {Register{can.mcr}, Register{can.msr}, Register{can.tsr}, Register{can.fmr}})
      word(one) = one.reset_value;
    for (auto& fifo : fifos_) fifo.clear();
    own_filters_ = {};
    frozen_ = false;
    if (changing_ != 0) events_.cancel(std::exchange(changing_, 0));
    if (sending_ != 0) events_.cancel(std::exchange(sending_, 0));
    update();
  }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    if (can.rfr.covers(offset)) return fifos_[can.rfr.index(offset)].status();
    if (offset >= can.rir && offset < can.rir + can.rir.count * can.rir.stride) {
      const std::uint32_t offset_in_fifos = offset - can.rir;
      return fifos_[offset_in_fifos / can.rir.stride].word(offset_in_fifos % can.rir.stride / 4);
    }
    return stored(offset);
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset >= bytes) return machine_.log.note("CAN" + std::to_string(number_), offset, true, value);
    if (can.tir.covers(offset)) {
      word(offset) = value & writable(can.tir);
      if (can.tir.txrq.in(value)) word(can.tsr) &= ~can.tsr.tme.mask(can.tir.index(offset));
      send();
    } else if (offset == can.mcr) {
      if (can.mcr.reset.in(value)) return reset();
      word(can.mcr) = value & writable(can.mcr);
      change_mode();
    } else if (offset == can.msr) {
      word(can.msr) &= ~(value & bits_of(can.msr, Access::rc_w1));
    } else if (offset == can.tsr) {
      write_transmit_status(value);
    } else if (offset == can.esr) {
      word(can.esr) = (word(can.esr) & ~can.esr.lec.mask()) | (value & can.esr.lec.mask());
    } else if (can.rfr.covers(offset)) {
      fifos_[can.rfr.index(offset)].write_status(value);
    } else {
      word(offset) = value;
      if (number_ == 1 && offset >= can.fmr) keep_filters();
    }
    update();
  }
  std::uint32_t stored(std::uint32_t offset) const override { return offset < bytes ? words_[offset / 4] : 0; }
  std::span<const MapEntry> registers() const override { return shown<can>(); }

 private:
  static constexpr std::uint32_t bytes = 0x320;
  std::uint32_t& word(std::uint32_t offset) { return words_[offset / 4]; }
  void keep_filters() {
    own_filters_.initialising = can.fmr.finit.in(word(can.fmr));
    own_filters_.first_of_second_controller = can.fmr.can2sb.of(word(can.fmr));
    own_filters_.lists = word(can.fm1r);
    own_filters_.whole_words = word(can.fs1r);
    own_filters_.second_fifo = word(can.ffa1r);
    own_filters_.active = word(can.fa1r);
    for (unsigned i = 0; i < CanFilters::banks; ++i)
      own_filters_.bank[i] = {word(can.first_filter + i * can.first_filter.stride),
                              word(can.second_filter + i * can.second_filter.stride)};
  }
  Ticks bits(unsigned count) {
    const std::uint32_t timing = word(can.btr);
    const std::uint64_t quanta = 3 + can.btr.ts1.of(timing) + can.btr.ts2.of(timing);
    return machine_.clocks.pclk1.duration(count * quanta * (can.btr.brp.of(timing) + 1));
  }
  // A mode change takes effect after eleven recessive bits. The bus has no other node and is always recessive.
  void change_mode() {
    if (changing_ != 0) events_.cancel(changing_);
    changing_ = events_.at(machine_.timeline.now() + bits(11), [this] {
      changing_ = 0;
      const std::uint32_t mode = word(can.mcr);
      const bool sleeps = can.mcr.sleep.in(mode);
      word(can.msr) &= ~(can.msr.inak.mask() | can.msr.slak.mask());
      word(can.msr) |= can.msr.slak.with(sleeps) | can.msr.inak.with(!sleeps && can.mcr.inrq.in(mode));
      send();
      update();
    });
  }
  void write_transmit_status(std::uint32_t value) {
    word(can.tsr) &= ~(value & bits_of(can.tsr, Access::rc_w1));
    for (unsigned i = 0; i < 3; ++i) {
      // A write of 1 to RQCP clears the result flags.
      if (can.tsr.rqcp.in(value, i))
        word(can.tsr) &= ~(can.tsr.txok.mask(i) | can.tsr.alst.mask(i) | can.tsr.terr.mask(i));
      if (can.tsr.abrq.in(value, i)) abort_mailbox(i);
    }
  }
  void abort_mailbox(unsigned mailbox) {
    if (can.tsr.tme.in(word(can.tsr), mailbox)) return;
    word(can.tsr) |= can.tsr.tme.mask(mailbox) | can.tsr.rqcp.mask(mailbox);
    word(can.tir + mailbox * can.tir.stride) &= ~can.tir.txrq.mask();
  }
  void send() {
    const bool waits = (word(can.tsr) & can.tsr.tme.masks()) != can.tsr.tme.masks();
    const bool on_bus = (word(can.msr) & (can.msr.inak.mask() | can.msr.slak.mask())) == 0;
    if (!waits || !on_bus || sending_ != 0 || frozen_) return;
    constexpr unsigned shortest_frame_bits = 47;
    const bool hears_itself = can.btr.lbkm.in(word(can.btr));
    const unsigned data_bits =
        hears_itself ? 8 * std::min(can.tdtr.dlc.of(word(can.tdtr + next_mailbox() * can.tdtr.stride)), 8u) : 0;
    sending_ = events_.at(machine_.timeline.now() + bits(shortest_frame_bits + data_bits), [this] {
      sending_ = 0;
      if (can.btr.lbkm.in(word(can.btr)))
        hear_itself();
      else
        miss_acknowledgement();
      send();
      update();
    });
  }
  /// Pending mailbox with the lowest identifier.
  unsigned next_mailbox() {
    unsigned next = 0;
    std::uint32_t lowest = ~0u;
    for (unsigned i = 0; i < 3; ++i) {
      const std::uint32_t identifier = word(can.tir + i * can.tir.stride) & ~can.tir.txrq.mask();
      if (can.tsr.tme.in(word(can.tsr), i) || identifier >= lowest) continue;
      lowest = identifier;
      next = i;
    }
    return next;
  }
  void hear_itself() {
    if ((word(can.tsr) & can.tsr.tme.masks()) == can.tsr.tme.masks()) return;  // aborted in the meantime
    const unsigned mailbox = next_mailbox();
    const auto sent = [&](const auto& registers) { return word(registers + mailbox * registers.stride); };
    CanFrame frame{sent(can.tir) & ~can.tir.txrq.mask(), can.tdtr.dlc.of(sent(can.tdtr)), sent(can.tdlr),
                   sent(can.tdhr)};
    abort_mailbox(mailbox);
    word(can.tsr) |= can.tsr.txok.mask(mailbox);
    const auto match = filters_.match(frame.identifier, number_);
    if (!match) return;
    frame.length |= can.rdtr.fmi.with(match->index);
    fifos_[match->fifo].put(frame, can.mcr.rflm.in(word(can.mcr)));
  }
  // Each missing acknowledgment adds 8 to the error counter, until the controller is error passive (ISO 11898-1).
  void miss_acknowledgement() {
    constexpr std::uint32_t no_acknowledgement = 3, warning = 96, passive = 128;
    std::uint32_t& errors = word(can.esr);
    const std::uint32_t count = can.esr.tec.of(errors) + (can.esr.epvf.in(errors) ? 0 : 8);
    errors = can.esr.lec.with(no_acknowledgement) | can.esr.tec.with(count) | can.esr.ewgf.with(count >= warning) |
             can.esr.epvf.with(count >= passive);
    const std::uint32_t enables = word(can.ier);
    const bool is_enabled = can.ier.lecie.in(enables) || (can.ier.ewgie.in(enables) && count == warning) ||
                            (can.ier.epvie.in(enables) && count == passive);
    if (is_enabled && can.ier.errie.in(enables)) word(can.msr) |= can.msr.erri.mask();
    if (!can.mcr.nart.in(word(can.mcr))) return;
    for (unsigned i = 0; i < 3; ++i)
      if (!can.tsr.tme.in(word(can.tsr), i)) {
        abort_mailbox(i);
        word(can.tsr) |= can.tsr.terr.mask(i);
        return;
      }
  }
  void update() {
    const std::uint32_t enables = word(can.ier), status = word(can.msr);
    machine_.nvic.set_source(first_position_, 0,
                             can.ier.tmeie.in(enables) && (word(can.tsr) & can.tsr.rqcp.masks()) != 0);
    const std::array enabled_by_fifo{std::array{&can.ier.fmpie0, &can.ier.ffie0, &can.ier.fovie0},
                                     std::array{&can.ier.fmpie1, &can.ier.ffie1, &can.ier.fovie1}};
    for (unsigned i = 0; i < 2; ++i) {
      const std::uint32_t fifo = fifos_[i].status();
      const bool is_enabled = (enabled_by_fifo[i][0]->in(enables) && can.rfr.fmp.in(fifo)) ||
                              (enabled_by_fifo[i][1]->in(enables) && can.rfr.full.in(fifo)) ||
                              (enabled_by_fifo[i][2]->in(enables) && can.rfr.fovr.in(fifo));
      machine_.nvic.set_source(first_position_ + 1 + i, 0, is_enabled);
    }
    machine_.nvic.set_source(first_position_ + 3, 0,
                             can.msr.erri.in(status) || (can.ier.wkuie.in(enables) && can.msr.wkui.in(status)) ||
                                 (can.ier.slkie.in(enables) && can.msr.slaki.in(status)));
  }

  Machine& machine_;
  Scheduler& events_;
  unsigned number_, first_position_;
  std::array<std::uint32_t, bytes / 4> words_{};
  std::array<CanFifo, 2> fifos_{};
  CanFilters own_filters_;
  const CanFilters& filters_;
  Scheduler::Id changing_ = 0, sending_ = 0;
  bool frozen_ = false;
};

}  // namespace inkwell::virtual_board
