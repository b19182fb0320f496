// Lock step of a program and its virtual boards. Each pose is a turn with three phases.
//
//   (1) Board time passes on all boards until the next pose.
//   (2) The library calls the servos and sends their forces. Board time is stopped.
//   (3) Waiting calls check their conditions.
//
// A turn begins when all threads have answered the previous pose. In a stepped group, a turn begins only while a
// library call waits. Program code between two calls uses no board time in a stepped group.
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
  /// Returns the group of all virtual boards started by this process. All boards of the group share one clock.
  static std::shared_ptr<Turns> of_own_boards();

  /// `waits_for_loops` is false for a board of another process.
  explicit Turns(bool waits_for_loops = true) : waits_for_loops_(waits_for_loops) {}

  /// Time limits for the answer to a pose. After the limit, board time passes without the answer. In a stepped group
  /// the limits are long, so that the computer load does not affect a run. Without stepped boards the limits are short,
  /// because a hanging servo would block other programs.
  struct Patience {
    std::chrono::milliseconds loop, servo;
  };
  static constexpr Patience patience{std::chrono::milliseconds(300), std::chrono::milliseconds(1500)};
  static constexpr Patience patience_if_stepped{std::chrono::seconds(3), std::chrono::seconds(60)};

  // ---- pose threads ----

  class Board {
   public:
    /// The board joins the group in its first turn. One stepped board makes the whole group stepped.
    Board(std::shared_ptr<Turns> turns, bool is_stepped);
    ~Board();
    Board(const Board&) = delete;
    Board& operator=(const Board&) = delete;

    /// From this call on, turns of a stepped board require a waiting library call.
    void let_program_decide();
    /// Waits for the next turn, which begins at the same time on all boards. Returns false after leave().
    bool begin();
    /// Waits until all boards of the turn have called meet(). Returns false after leave().
    bool meet();
    /// Waits until all servos have answered the pose. The time limit prevents a deadlock with a servo that waits for
    /// another thread. Returns false after leave().
    bool wait_for_servos();
    void end();
    /// Removes the board from the group after a lost link. The board rejoins the group in its next turn.
    void pause();
    /// Removes the board from the group. Another thread may call this function. All waiting functions of this board
    /// return.
    void leave();

   private:
    friend class Turns;
    const std::shared_ptr<Turns> turns_;
    const bool is_stepped_;
    // The group's mutex guards the following members.
    bool is_opening_ = true;
    bool is_ready_ = false;  ///< ready for the next turn
    bool is_in_turn_ = false;
    bool has_left_ = false;
    unsigned met_ = 0;  ///< number of meet() calls in this turn
  };

  // ---- calling threads ----

  enum class Answer : std::uint8_t {
    none,
    loop,   ///< a loop that waits for a pose and sets a force; it may stop without notice
    servo,  ///< a servo, which always waits for the next pose
  };
  /// Registers an answer until this thread calls begin_waiting() or end_answer().
  void begin_answer(std::thread::id thread, Answer answer);
  void end_answer(std::thread::id thread);
  /// Registers a wait of this thread for board time. Returns the previous answer of the thread.
  Answer begin_waiting(std::thread::id thread);
  /// The wait is over. If `answer` is not none, the thread now answers the newest pose.
  void end_waiting(std::thread::id thread, Answer answer);

 private:
  bool is_waited_for(Answer answer) const {
    return answer == Answer::servo || (answer == Answer::loop && waits_for_loops_);
  }
  bool is_stepped() const;
  /// Removes answers that have exceeded their time limit.
  void forget_late_answers(std::chrono::milliseconds waited);
  bool may_begin() const;
  void begin_turn();

  const bool waits_for_loops_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<Board*> boards_;  ///< from their first turn on
  std::uint64_t turn_ = 0;
  unsigned waiting_ = 0;  ///< number of waiting calls
  std::map<std::thread::id, Answer> answering_;
};

}  // namespace inkwell::library
