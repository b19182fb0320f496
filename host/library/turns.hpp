// Lock step: the program and its virtual boards take turns, and each pose is a turn.
//
//   1. Board time passes until the next pose, on every board of the group.
//   2. Servos are called with it, and their forces are handed over. Board time stands still.
//   3. The calls that wait for board time look whether they are done.
//
// A turn begins when no thread answers a pose. If the group is stepped, also only while some call waits: whatever the
// program does between two calls then takes no board time, and the same program gives the same run on any computer.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

namespace inkwell::library {

class Turns {
 public:
  /// Of the virtual boards that this process has started: they share one clock.
  static std::shared_ptr<Turns> of_own_boards();

  /// A board of another process does not wait for loops: other programs use its time too.
  explicit Turns(bool waits_for_loops = true) : waits_for_loops_(waits_for_loops) {}

  /// How long an answer may take before board time passes without it. In a stepped group the limits are long, so that
  /// they do not depend on the load of the computer. The others are shorter than the silence after which a program
  /// regards its board as lost: a servo that hangs does not take the board from other programs.
  struct Patience {
    std::chrono::milliseconds loop, servo;
  };
  static constexpr Patience patience{std::chrono::milliseconds(300), std::chrono::milliseconds(1500)};
  static constexpr Patience patience_if_stepped{std::chrono::seconds(3), std::chrono::seconds(60)};

  // ---- threads that read poses, one for each board ----

  class Board {
   public:
    /// In the group from its first turn on. `is_stepped` makes the whole group stepped meanwhile.
    Board(std::shared_ptr<Turns> turns, bool is_stepped);
    ~Board();
    Board(const Board&) = delete;
    Board& operator=(const Board&) = delete;

    /// Until this call, turns of a stepped board begin by themselves.
    void let_program_decide();
    /// Waits until the next turn begins, in the same instant for all boards. False after `leave`.
    bool begin();
    /// Waits until all boards of the turn are as far. False after `leave`.
    bool meet();
    /// Waits until no servo answers a pose, but not for ever: the thread that would let it return may wait for the
    /// board. False after `leave`.
    bool wait_for_servos();
    void end();
    /// The link of the board is lost: it is in the group again from its next turn on, which begins by itself.
    void pause();
    /// The board takes no part any more. Another thread may call this: the calls above then return.
    void leave();

   private:
    friend class Turns;
    const std::shared_ptr<Turns> turns_;
    const bool is_stepped_;
    // Guarded by the group's mutex.
    bool is_opening_ = true;
    bool is_ready_ = false;  ///< for the next turn
    bool is_in_turn_ = false;
    bool has_left_ = false;
    unsigned met_ = 0;  ///< how often in this turn
  };

  // ---- threads that call the library ----

  enum class Answer : std::uint8_t {
    none,
    loop,   ///< a loop that waits for a pose and sets a force; it may be over without a word
    servo,  ///< a servo, which comes back
  };
  /// This thread answers a pose until it waits again, or until it ends the answer.
  void begin_answer(std::thread::id thread, Answer answer);
  void end_answer(std::thread::id thread);
  /// This thread waits for board time, and answers no pose meanwhile. Returns what it did before.
  Answer begin_waiting(std::thread::id thread);
  /// The call is done, and its thread answers the pose at which it is, if it is to.
  void end_waiting(std::thread::id thread, Answer answer);

 private:
  bool is_waited_for(Answer answer) const {
    return answer == Answer::servo || (answer == Answer::loop && waits_for_loops_);
  }
  bool is_stepped() const;
  /// Stops the wait for answers that have taken too long.
  void forget_late_answers(std::chrono::milliseconds waited);
  bool may_begin() const;
  void begin_turn();

  const bool waits_for_loops_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<Board*> boards_;  ///< from their first turn on
  std::uint64_t turn_ = 0;
  unsigned waiting_ = 0;  ///< calls
  std::map<std::thread::id, Answer> answering_;
};

}  // namespace inkwell::library
