// I2C1 to I2C3 on a bus with two pull-up resistors and no other device (RM0090, "Inter-integrated circuit interface").
// Start conditions work. The controller sends addresses, but no device acknowledges them. The chip is never addressed
// as a slave.
#pragma once

#include <utility>

#include "boards/stm32f405/memory/register_block.hpp"

namespace inkwell::virtual_board {

struct I2cRegisters {
  struct : Register {
    Field pe{"PE", 0}, smbus{"SMBUS", 1}, smbtype{"SMBTYPE", 3}, enarp{"ENARP", 4}, enpec{"ENPEC", 5}, engc{"ENGC", 6},
        nostretch{"NOSTRETCH", 7}, start{"START", 8}, stop{"STOP", 9}, ack{"ACK", 10}, pos{"POS", 11}, pec{"PEC", 12},
        alert{"ALERT", 13}, swrst{"SWRST", 15};
  } cr1{{"CR1", 0x00}};
  struct : Register {
    Field freq{"FREQ", 0, 6}, iterren{"ITERREN", 8}, itevten{"ITEVTEN", 9}, itbufen{"ITBUFEN", 10}, dmaen{"DMAEN", 11},
        last{"LAST", 12};
  } cr2{{"CR2", 0x04}};
  struct : Register {
    Field add0{"ADD0", 0}, add7{"ADD7", 1, 7}, add10{"ADD10", 8, 2}, addmode{"ADDMODE", 15};
  } oar1{{"OAR1", 0x08}};
  struct : Register {
    Field endual{"ENDUAL", 0}, add2{"ADD2", 1, 7};
  } oar2{{"OAR2", 0x0C}};
  struct : Register {
    Field dr{"DR", 0, 8};
  } dr{{"DR", 0x10}};
  struct : Register {
    Field sb{"SB", 0, 1, Access::r}, addr{"ADDR", 1, 1, Access::r}, btf{"BTF", 2, 1, Access::r},
        add10{"ADD10", 3, 1, Access::r}, stopf{"STOPF", 4, 1, Access::r}, rxne{"RxNE", 6, 1, Access::r},
        txe{"TxE", 7, 1, Access::r}, berr{"BERR", 8, 1, Access::rc_w0}, arlo{"ARLO", 9, 1, Access::rc_w0},
        af{"AF", 10, 1, Access::rc_w0}, ovr{"OVR", 11, 1, Access::rc_w0}, pecerr{"PECERR", 12, 1, Access::rc_w0},
        timeout{"TIMEOUT", 14, 1, Access::rc_w0}, smbalert{"SMBALERT", 15, 1, Access::rc_w0};
  } sr1{{"SR1", 0x14}};
  struct : Register {
    Field msl{"MSL", 0, 1, Access::r}, busy{"BUSY", 1, 1, Access::r}, tra{"TRA", 2, 1, Access::r};
  } sr2{{"SR2", 0x18}};
  struct : Register {
    Field ccr{"CCR", 0, 12}, duty{"DUTY", 14}, f_s{"F_S", 15};
  } ccr{{"CCR", 0x1C}};
  struct : Register {
    Field trise{"TRISE", 0, 6};
  } trise{{"TRISE", 0x20, 0x0002}};
};
inline constexpr I2cRegisters i2c;

class I2c final : public RegisterBlock {
 public:
  I2c(Machine& machine, Scheduler& events, unsigned number, unsigned event_position)
      : machine_(machine), events_(events), number_(number), event_position_(event_position) {}
  void reset() override {
    words_ = {};
    words_[i2c.trise / 4] = i2c.trise.reset_value;
    if (under_way_ != 0) events_.cancel(std::exchange(under_way_, 0));
    update();
  }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    if (offset > i2c.trise) machine_.log.note("I2C" + std::to_string(number_), offset, false, 0);
    return stored(offset);
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    switch (offset) {
      case i2c.cr1: write_control(value & writable(i2c.cr1)); break;
      case i2c.cr2: word(i2c.cr2) = value & writable(i2c.cr2); break;
      case i2c.oar1: word(i2c.oar1) = value & writable(i2c.oar1); break;
      case i2c.oar2: word(i2c.oar2) = value & writable(i2c.oar2); break;
      case i2c.ccr: word(i2c.ccr) = value & writable(i2c.ccr); break;
      case i2c.trise: word(i2c.trise) = value & writable(i2c.trise); break;
      case i2c.sr1: word(i2c.sr1) &= value | ~bits_of(i2c.sr1, Access::rc_w0); break;
      case i2c.dr:
        if (!i2c.sr1.sb.in(word(i2c.sr1))) break;
        word(i2c.sr1) &= ~i2c.sr1.sb.mask();
        after_bits(9, [this] { word(i2c.sr1) |= i2c.sr1.af.mask(); });
        break;
      default: return machine_.log.note("I2C" + std::to_string(number_), offset, true, value);
    }
    update();
  }
  std::uint32_t stored(std::uint32_t offset) const override { return offset <= i2c.trise ? words_[offset / 4] : 0; }
  std::span<const MapEntry> registers() const override { return shown<i2c>(); }

 private:
  std::uint32_t& word(std::uint32_t offset) { return words_[offset / 4]; }
  void write_control(std::uint32_t value) {
    if (i2c.cr1.swrst.in(value)) reset();
    word(i2c.cr1) = value;
    if (!i2c.cr1.pe.in(value)) {
      word(i2c.sr1) = word(i2c.sr2) = 0;
      word(i2c.cr1) &= ~(i2c.cr1.start.mask() | i2c.cr1.stop.mask());
    } else if (i2c.cr1.stop.in(value)) {
      after_bits(1, [this] {
        word(i2c.cr1) &= ~i2c.cr1.stop.mask();
        word(i2c.sr2) = 0;
      });
    } else if (i2c.cr1.start.in(value)) {
      word(i2c.sr2) |= i2c.sr2.busy.mask();
      after_bits(1, [this] {
        word(i2c.cr1) &= ~i2c.cr1.start.mask();
        word(i2c.sr1) |= i2c.sr1.sb.mask();
        word(i2c.sr2) |= i2c.sr2.msl.mask() | i2c.sr2.busy.mask();
      });
    }
  }
  template <class Action>
  void after_bits(unsigned bits, Action action) {
    if (under_way_ != 0) events_.cancel(under_way_);
    const std::uint64_t half = std::max<std::uint64_t>(1, i2c.ccr.ccr.of(word(i2c.ccr)));
    under_way_ = events_.at(machine_.timeline.now() + machine_.clocks.pclk1.duration(2 * half * bits), [this, action] {
      under_way_ = 0;
      action();
      update();
    });
  }
  void update() {
    const std::uint32_t enables = words_[i2c.cr2 / 4], status = words_[i2c.sr1 / 4];
    machine_.nvic.set_source(event_position_, 0, i2c.cr2.itevten.in(enables) && i2c.sr1.sb.in(status));
    machine_.nvic.set_source(event_position_ + 1, 0,
                             i2c.cr2.iterren.in(enables) && (status & bits_of(i2c.sr1, Access::rc_w0)) != 0);
  }

  Machine& machine_;
  Scheduler& events_;
  unsigned number_, event_position_;
  std::array<std::uint32_t, i2c.trise / 4 + 1> words_{};
  Scheduler::Id under_way_ = 0;
};

}  // namespace inkwell::virtual_board
