// Lock step of a program and its virtual boards. Each pose is a turn, which has these phases:
//
//   (1) Board time passes until the next pose, on every board of the group.
//   (2) Servos are called with the pose, and their forces are sent. Board time is stopped.
//   (3) Calls that wait for board time check whether they are done.
//
// A turn begins when no thread answers a pose. In a stepped group a turn also requires a waiting call. Program code
// between two calls therefore uses no board time, and a run is the same on any computer.
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
  /// Returns the group of all virtual boards started by this process. They share one clock.
  static std::shared_ptr<Turns> of_own_boards();

  /// A board of another process does not wait for loops, because other programs may use the board.
  explicit Turns(bool waits_for_loops = true) : waits_for_loops_(waits_for_loops) {}

  /// Longest time for an answer. After this time, board time passes without the answer. In a stepped group the limits
  /// are long, so that the computer load does not affect a run. Without stepped boards the limits are short, so that a
  /// hanging servo does not block the board for other programs.
  struct Patience {
    std::chrono::milliseconds loop, servo;
  };
  static constexpr Patience patience{std::chrono::milliseconds(300), std::chrono::milliseconds(1500)};
  static constexpr Patience patience_if_stepped{std::chrono::seconds(3), std::chrono::seconds(60)};

  // ---- threads that read poses, one for each board ----

  class Board {
   public:
    /// The board joins the group in its first turn. While a board with `is_stepped` belongs to the group, the whole
    /// group is stepped.
    Board(std::shared_ptr<Turns> turns, bool is_stepped);
    ~Board();
    Board(const Board&) = delete;
    Board& operator=(const Board&) = delete;

    /// Before this call, turns of a stepped board begin without a waiting call.
    void let_program_decide();
    /// Waits until the next turn begins, simultaneously for all boards. False after `leave`.
    bool begin();
    /// Waits until all boards of the turn have reached the same step. False after `leave`.
    bool meet();
    /// Waits until no servo answers a pose. The wait has a time limit, because a servo may itself wait for a thread
    /// that waits for the board. False after `leave`.
    bool wait_for_servos();
    void end();
    /// The link of the board is lost. The board rejoins the group in its next turn, which begins without a waiting
    /// call.
    void pause();
    /// Removes the board from the group. Another thread may call this function. Waiting calls of the removed board
    /// return.
    void leave();

   private:
    friend class Turns;
    const std::shared_ptr<Turns> turns_;
    const bool is_stepped_;
    // Guarded by the mutex of the group.
    bool is_opening_ = true;
    bool is_ready_ = false;  ///< ready for the next turn
    bool is_in_turn_ = false;
    bool has_left_ = false;
    unsigned met_ = 0;  ///< number of meet() calls in this turn
  };

  // ---- threads that call the library ----

  enum class Answer : std::uint8_t {
    none,
    loop,   ///< a loop that waits for a pose and sets a force; it may stop without notice
    servo,  ///< a servo, which always waits for the next pose
  };
  /// This thread answers a pose until it waits again, or until it ends the answer.
  void begin_answer(std::thread::id thread, Answer answer);
  void end_answer(std::thread::id thread);
  /// This thread waits for board time and answers no pose meanwhile. Returns its previous answer.
  Answer begin_waiting(std::thread::id thread);
  /// The wait is over. The thread then answers the newest pose if `answer` is not none.
  void end_waiting(std::thread::id thread, Answer answer);

 private:
  bool is_waited_for(Answer answer) const {
    return answer == Answer::servo || (answer == Answer::loop && waits_for_loops_);
  }
  bool is_stepped() const;
  /// Stops waiting for answers that have exceeded their time limit.
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
