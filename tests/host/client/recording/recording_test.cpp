// Tests that written data remains readable after a crash or on a full disk, and that damaged files cause an error.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <thread>

#include <fcntl.h>
#include <hdf5.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/client/recording/event_feed.hpp"
#include "host/client/recording/recorder.hpp"
#include "host/client/recording/recording.hpp"
#include "host/client/recording/sha256.hpp"
#include "host/client/recording/stored_recording.hpp"
#include "host/client/recording/writer.hpp"

#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::recording;
using inkwell::tests::message_of;
using inkwell::tests::TemporaryDirectory;
using protocol::Parameter;
using protocol::Signal;
using protocol::SimulatedQuantity;

namespace {

namespace fs = std::filesystem;

Information about() {
  Information about{.created_utc = "2026-01-02T03:04:05Z",
                    .firmware_version = "0.1.0",
                    .serial_number = "0123456789ABCDEF01234567",
                    .arm = "PHANTOM Omni",
                    .simulation = true,
                    .parameters = protocol::default_parameters(),
                    .signals = {Signal::force_N, Signal::position_x_m, Signal::duty_1}};
  about.parameters[Parameter::wall_stiffness_N_per_m] = 432.5f;
  return about;
}

device::ScopeSamples samples(std::int64_t first_period, std::size_t count) {
  device::ScopeSamples samples{.signals = about().signals, .first_period = first_period, .count = count, .values = {}};
  for (std::size_t i = 0; i < count; ++i) {
    const float at = static_cast<float>(first_period + static_cast<std::int64_t>(i));
    samples.values.insert(samples.values.end(), {at * 0.001f, 1.0f / (1.0f + at), -at});
  }
  return samples;
}

const std::string long_text(120, 'x');  // the length that HDF5 reserves for a text

/// This recording has a gap and simulated quantities.
Recording simulated() {
  auto recording = Recording::without_samples(about());
  recording.append(samples(300, 5000));
  recording.append(samples(6000, 700));
  recording.information.simulated = {SimulatedQuantity::hand_force_z_N, SimulatedQuantity::true_current_2_A};
  recording.simulated_columns.resize(2);
  for (const std::int64_t period : recording.periods) {
    recording.simulated_columns[0].push_back(0.5f * static_cast<float>(period));
    recording.simulated_columns[1].push_back(-1.0f / static_cast<float>(period));
  }
  recording.marks = {{310, "first"}, {6001, "second"}};
  return recording;
}

/// Replaces a column by 32-bit numbers, as in files of earlier versions.
void write_as_32_bits(const fs::path& file, const char* column, const std::vector<std::uint32_t>& values) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(opened >= 0);
  H5Ldelete(opened, column, H5P_DEFAULT);
  const hsize_t size = values.size();
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t made = H5Dcreate2(opened, column, H5T_STD_U32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  CHECK(H5Dwrite(made, H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  H5Dclose(made);
  H5Sclose(space);
  H5Fclose(opened);
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void check_is_whole(const Recording& recording, std::int64_t first_period, std::size_t count) {
  REQUIRE(recording.size() == count);
  const auto expected = samples(first_period, count);
  const auto& force_N = recording.column(Signal::force_N);
  const auto& position_x_m = recording.column(Signal::position_x_m);
  const auto& duty_1 = recording.column(Signal::duty_1);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i)
    wrong += recording.periods[i] != first_period + static_cast<std::int64_t>(i) ||
             force_N[i] != expected.values[3 * i] || position_x_m[i] != expected.values[3 * i + 1] ||
             duty_1[i] != expected.values[3 * i + 2];
  CHECK(wrong == 0);
}

/// Checks that the file is marked as incomplete and contains all written samples.
void check_broke_off(const fs::path& file) {
  const auto recording = read(file);
  CHECK_FALSE(recording.complete);
  CHECK(recording.size() > 1000);
  check_is_whole(recording, 0, recording.size());
}

std::string error_of(const fs::path& file) {
  return message_of<device::Error>([&] { read(file); });
}

}  // namespace

TEST_CASE("a recording is read back unchanged") {
  const TemporaryDirectory directory;
  for (const char* name : {"a.h5", "a.csv"}) {
    CAPTURE(name);
    const auto file = directory / name;
    {
      Recorder recorder(file, about());
      for (std::uint32_t period = 5000; period < 15000; period += 50) {
        recorder.push(samples(period, 50));
        if (period == 5950) recorder.mark("approach");
      }
      recorder.mark("touch");
      recorder.mark(long_text);
      const auto end = recorder.stop();
      CHECK(end.error.empty());
      CHECK(end.samples == 10'000);
      CHECK(end.duration_s == doctest::Approx(0.49995));
      CHECK(end.bytes > 50'000);
      CHECK_FALSE(end.running);
    }
    const auto recording = read(file);
    check_is_whole(recording, 5000, 10'000);
    CHECK(recording.complete);
    CHECK(recording.lost() == 0);
    CHECK(recording.remarks.empty());
    REQUIRE(recording.marks.size() == 3);
    CHECK(recording.marks[0].text == "approach");
    CHECK(recording.marks[0].period == 5'999);
    CHECK(recording.marks[1].text == "touch");
    CHECK(recording.marks[1].period == 14'999);
    CHECK(recording.marks[2].text == long_text);
    CHECK(recording.marks[2].period == 14'999);
    CHECK(recording.information.parameters == about().parameters);
    CHECK(recording.information.arm == "PHANTOM Omni");
    CHECK(recording.information.firmware_version == "0.1.0");
    CHECK(recording.information.serial_number == about().serial_number);
    CHECK(recording.information.simulation);
    CHECK(recording.information.created_utc == about().created_utc);
  }
}

TEST_CASE("both file formats preserve the simulated quantities of a recording") {
  const TemporaryDirectory directory;
  const auto whole = simulated();
  for (const char* name : {"a.h5", "a.csv"}) {
    CAPTURE(name);
    save(whole, directory / name);
    CHECK(std::ranges::none_of(fs::directory_iterator(directory.path()), [](const fs::directory_entry& entry) {
      return entry.path().filename().string().find(".part") != std::string::npos;
    }));
    const auto recording = read(directory / name);
    CHECK(recording.complete);
    CHECK(recording.remarks.empty());
    CHECK(recording.lost() == 700);
    CHECK(recording.periods == whole.periods);
    REQUIRE(recording.quantities().size() == 5);
    for (const auto quantity : whole.quantities()) CHECK(recording.column(quantity) == whole.column(quantity));
    REQUIRE(recording.marks.size() == 2);
    CHECK(recording.marks[1].text == "second");
    CHECK(recording.information.parameters == about().parameters);
  }
  const auto csv = text_of(directory / "a.csv");
  CHECK(csv.find("\n# unit true_current_2_A = A\n") != std::string::npos);
  CHECK(csv.find("\n# simulated true_current_2_A = Current in the simulated motor 2") != std::string::npos);
  CHECK(csv.find("\ntime_s,force_N,position_x_m,duty_1,hand_force_z_N,true_current_2_A\n") != std::string::npos);
}

TEST_CASE("an extension in upper case selects the format of a recording") {
  const TemporaryDirectory directory;
  for (const char* name : {"a.H5", "a.HDF5", "a.CSV"}) {
    CAPTURE(name);
    save(simulated(), directory / name);
    CHECK(read(directory / name).periods == simulated().periods);
    CHECK(text_of(directory / name).starts_with('#') == (std::string(name) == "a.CSV"));
    CHECK_NOTHROW(check_can_be_created(directory / (std::string("new_") + name)));
  }
}

TEST_CASE("a CSV recording that a Windows program has saved is read") {
  const TemporaryDirectory directory;
  save(simulated(), directory / "a.csv");
  std::string text = "\xEF\xBB\xBF";
  for (const char c : text_of(directory / "a.csv")) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  std::ofstream(directory / "b.csv", std::ios::binary) << text << "\r\n\r\n";
  const auto recording = read(directory / "b.csv");
  CHECK(recording.complete);
  CHECK(recording.remarks.empty());
  CHECK(recording.periods == simulated().periods);
  for (const auto quantity : simulated().quantities())
    CHECK(recording.column(quantity) == simulated().column(quantity));
  CHECK(recording.marks.size() == 2);
  CHECK(recording.information.parameters == about().parameters);
}

TEST_CASE("a recording that cannot be saved does not change the previous file") {
  const TemporaryDirectory directory;
  save(simulated(), directory / "a.csv");
  auto other = simulated();
  other.keep(0, 10);
  save(other, directory / "a.csv");
  CHECK(read(directory / "a.csv").size() == 10);
  CHECK(read(directory / "a.csv").column(SimulatedQuantity::hand_force_z_N)[9] == 0.5f * 309);
  CHECK_THROWS_AS(save(other, directory / "nowhere" / "a.csv"), device::Error);

  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100'000, 100'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      save(simulated(), directory / "a.csv");
    } catch (const device::Error& error) {
      const std::string what = error.what();
      const bool names_what_was_asked_for =
          what.starts_with((directory / "a.csv").string()) && what.find(".part") == std::string::npos;
      _exit(names_what_was_asked_for ? 42 : 43);
    }
    _exit(1);
  }
  int result = 0;
  waitpid(child, &result, 0);
  CHECK(WEXITSTATUS(result) == 42);
  CHECK(read(directory / "a.csv").size() == 10);
  CHECK(std::distance(fs::directory_iterator(directory.path()), fs::directory_iterator()) == 1);  // no partial file
}

TEST_CASE("a recording is cut to a part of its samples") {
  auto recording = simulated();
  recording.keep(4990, 5010);
  CHECK(recording.size() == 20);
  CHECK(recording.periods.front() == 5290);
  CHECK(recording.lost() == 700);
  CHECK(recording.end_of_stretch(0, 20) == 10);
  CHECK(recording.column(Signal::duty_1).size() == 20);
  CHECK(recording.column(SimulatedQuantity::hand_force_z_N)[19] == 0.5f * 6009);
  const auto stretch = recording.samples(10, 20);
  CHECK(stretch.first_period == 6000);
  CHECK(stretch.lost_before == 700);
  recording.keep(0, 0);
  CHECK(recording.size() == 0);
  CHECK(recording.column(Signal::duty_1).empty());
}

TEST_CASE("samples that were lost show as a gap and are counted") {
  const TemporaryDirectory directory;
  Recorder recorder(directory / "a.h5", about());
  auto first = samples(100, 10);
  first.lost_before = 77;  // lost before the recording began, so not counted
  recorder.push(first);
  auto second = samples(130, 10);
  second.lost_before = 20;
  recorder.push(second);
  CHECK(recorder.stop().lost == 20);
  CHECK(read(directory / "a.h5").lost() == 20);
}

TEST_CASE("a recording is complete only if nothing is missing") {
  const TemporaryDirectory directory;
  for (const std::string ending : {".h5", ".csv"}) {
    const auto is_complete = [&](const std::string& name, const auto& use) {
      Recorder recorder(directory / (name + ending), about());
      recorder.push(samples(100, 10));
      use(recorder);
      const auto status = recorder.stop();
      CHECK(read(directory / (name + ending)).complete == status.is_complete);
      return status.is_complete;
    };
    CHECK(is_complete("whole", [](Recorder& recorder) { recorder.push(samples(110, 10)); }));
    CHECK_FALSE(is_complete("lost", [](Recorder& recorder) { recorder.push(samples(111, 10)); }));
    CHECK_FALSE(is_complete("unplugged", [](Recorder& recorder) { recorder.miss_end(); }));
    CHECK_FALSE(is_complete("restarted", [](Recorder& recorder) { recorder.push(samples(0, 10)); }));
  }
}

TEST_CASE("a recording states its name, its note, what recorded it, and the time of the computer") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "arm.toml") << "abc";
  device::Information device{.firmware_version = "0.1.0", .protocol_version = 1, .serial_number = "", .report = {}};
  device.report.image_check = 0x0BADCAFE;
  const auto described =
      describe(device, protocol::default_parameters(), about().signals, "", false,
               {.name = "subject 7", .note = "left hand", .image = {}, .arm_description = directory / "arm.toml"});
  CHECK(described.created_utc.size() == std::string("2026-01-02T03:04:05.123456Z").size());
  CHECK(described.library_sha256 == sha256_of_file("/proc/self/exe"));
  const auto before_us =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count();
  for (const char* name : {"a.h5", "a.csv"}) {
    CAPTURE(name);
    {
      Recorder recorder(directory / name, described);
      for (std::int64_t period = 0; period < 45'000; period += 1000) recorder.push(samples(period, 1000));
    }
    const auto recording = read(directory / name);
    const auto& about = recording.information;
    CHECK(about.name == "subject 7");
    CHECK(about.note == "left hand");
    CHECK(about.library_version == described.library_version);
    CHECK(about.library_sha256 == described.library_sha256);
    CHECK(about.image_sha256.empty());
    CHECK(about.image_check == "0badcafe");
    CHECK(about.arm_sha256 == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    REQUIRE(recording.clock.size() == 3);
    CHECK(recording.clock[0].period == 999);
    CHECK(recording.clock[2].period == 40'999);
    CHECK(recording.clock[0].utc_us >= before_us);
    CHECK(recording.clock[2].utc_us < before_us + 60'000'000);
  }
}

TEST_CASE("lost poses, lost samples and buttons are events of a recording") {
  const TemporaryDirectory directory;
  {
    Recorder recorder(directory / "a.h5", about());
    EventFeed feed(recorder);
    device::Pose pose{.state = protocol::State::ready, .sequence = 10, .time_periods = 120};
    recorder.push(samples(100, 50));
    feed.take(pose);
    pose.sequence = 14;
    pose.time_periods = 200;
    pose.switches = 1;
    recorder.push(samples(160, 50));
    feed.take(pose);
    CHECK(feed.lost_poses() == 3);
  }
  const auto marks = read(directory / "a.h5").marks;
  REQUIRE(marks.size() == 3);
  CHECK(marks[0].text == "3 poses were lost.");
  CHECK(marks[0].kind == device::EventKind::loss);
  CHECK(marks[0].period == 200);
  CHECK(marks[1].text == "Button 1 was pressed.");
  CHECK(marks[2].text == "10 samples were lost.");
}

TEST_CASE("the hash of a file is the one that sha256sum prints") {
  const auto hash = [](const std::string& text) { return sha256_of(std::as_bytes(std::span(text))); };
  CHECK(hash("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(hash("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(hash(std::string(1'000'000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  CHECK(sha256_of_file("/no/such/file").empty());
}

TEST_CASE("marks of device events are sorted by control period and contain the kind and the clock of the event") {
  const TemporaryDirectory directory;
  for (const char* name : {"a.h5", "a.csv"}) {
    CAPTURE(name);
    Recorder recorder(directory / name, about());
    recorder.note({device::EventKind::connection, "before the first sample", "2026-11-23T22:15:30.000Z", 40});
    recorder.push(samples(1000, 500));
    recorder.mark("of the user, at the newest sample");
    recorder.note(
        {device::EventKind::parameter, "wall_stiffness_N_per_m = 600.0, was 800.0", "2026-11-23T22:15:34.123Z", 1234});
    recorder.note({device::EventKind::fault, "of an earlier time", "2026-11-23T22:15:35.000Z", 900});
    CHECK(recorder.stop().marks == 4);
    const auto marks = read(directory / name).marks;
    REQUIRE(marks.size() == 4);
    CHECK(marks[0].period == 1000);
    CHECK(marks[0].kind == device::EventKind::connection);
    CHECK(marks[1].period == 1000);
    CHECK(marks[1].kind == device::EventKind::fault);
    CHECK(marks[2].period == 1234);
    CHECK(marks[2].kind == device::EventKind::parameter);
    CHECK(marks[2].clock_utc == "2026-11-23T22:15:34.123Z");
    CHECK(marks[2].text == "wall_stiffness_N_per_m = 600.0, was 800.0");
    CHECK(marks[3].period == 1499);
    CHECK(marks[3].kind == device::EventKind::mark);
    const auto log = log_text(read(directory / name));
    CHECK(log.find("2026-11-23T22:15:34.123Z          0.01170 s  parameter   wall_stiffness") != std::string::npos);
    CHECK(std::ranges::count(log, '\n') == 4);
  }
}

TEST_CASE("a board that was restarted ends the recording") {
  const TemporaryDirectory directory;
  Recorder recorder(directory / "a.h5", about());
  recorder.mark("set before the first sample, which gets it");
  recorder.push(samples(1000, 100));
  recorder.push(samples(0, 100));
  recorder.push(samples(100, 100));
  const auto end = recorder.stop();
  CHECK(end.error.find("restarted") != std::string::npos);
  const auto recording = read(directory / "a.h5");
  check_is_whole(recording, 1000, 100);
  REQUIRE(recording.marks.size() == 1);
  CHECK(recording.marks[0].period == recording.periods.front());
}

TEST_CASE("an arm with the default parameters has the default name") {
  device::Information device{.firmware_version = "0.1.0", .protocol_version = 1, .serial_number = "", .report = {}};
  auto parameters = protocol::default_parameters();
  parameters[Parameter::box_minimum_x_m] = -0.01f;  // a value of the user, not of the arm
  CHECK(describe(device, parameters, {}, "", false).arm == "PHANTOM Omni");
  CHECK(describe(device, parameters, {}, "another", false).arm == "another");
  parameters[Parameter::link_2_m] = 0.2f;
  CHECK(describe(device, parameters, {}, "", false).arm.empty());
}

TEST_CASE("samples are found by their time") {
  Recording recording;
  recording.periods = {100, 101, 102, 110, 111};
  CHECK(recording.sample_at(-1) == 0);
  CHECK(recording.sample_at(0) == 0);
  CHECK(recording.sample_at(50e-6) == 1);
  CHECK(recording.sample_at(51e-6) == 2);
  CHECK(recording.sample_at(150e-6) == 3);  // in the gap: the first sample after it
  CHECK(recording.sample_at(1) == 5);
  CHECK_THROWS_AS(recording.column(Signal::force_N), device::Error);
}

TEST_CASE("an existing file is not overwritten, an unknown ending not guessed") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.h5") << "precious";
  CHECK_THROWS_AS(Recorder(directory / "a.h5", about()), device::Error);
  CHECK_THROWS_AS(Recorder(directory / "a.mat", about()), device::Error);
  CHECK_THROWS_AS(Recorder(directory / "missing" / "a.h5", about()), device::Error);
  // Other write errors are not reported as a full disk.
  const auto refusal = message_of<device::Error>([] { Recorder("/proc/a.h5", about()); });
  CHECK(refusal.find("the system refused access") != std::string::npos);
  CHECK(fs::file_size(directory / "a.h5") == 8);
}

TEST_CASE("a recording survives the death of its program") {
  const TemporaryDirectory directory;
  for (const char* name : {"a.h5", "a.csv"}) {
    CAPTURE(name);
    const auto file = directory / name;
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      // Writes samples until the process is killed.
      Recorder recorder(file, about());
      for (std::uint32_t period = 0;; period += 100) {
        recorder.push(samples(period, 100));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2500));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    check_broke_off(file);
  }
}

TEST_CASE("a recording can be read while a process runs that was started meanwhile") {
  const TemporaryDirectory directory;
  const auto file = directory.file("run.h5");
  Recorder recorder(file, about());
  bool is_open = false;
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    if (fs::read_symlink(entry.path(), gone) != fs::canonical(file)) continue;
    is_open = true;
    CHECK((fcntl(std::stoi(entry.path().filename().string()), F_GETFD) & FD_CLOEXEC) != 0);
  }
  CHECK(is_open);
  struct Other {
    pid_t process = fork();
    ~Other() {
      if (process <= 0) return;
      kill(process, SIGKILL);
      waitpid(process, nullptr, 0);
    }
  } other;
  if (other.process == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    pause();
    _exit(0);
  }
  REQUIRE(other.process > 0);
  recorder.push(samples(1, 9'000));
  CHECK(recorder.stop().error.empty());
  check_is_whole(read(file), 1, 9'000);
}

TEST_CASE("a full disk ends the recording with a sentence, and the written samples remain") {
  const TemporaryDirectory directory;
  for (const char* name : {"a.h5", "a.csv"}) {
    CAPTURE(name);
    const auto file = directory / name;
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      // A file size limit makes the same system call fail as a full disk.
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{2'000'000, 2'000'000};
      setrlimit(RLIMIT_FSIZE, &limit);
      Recorder recorder(file, about());
      RecorderStatus status = recorder.status();
      for (std::uint32_t period = 0; status.running && period < 20'000'000; period += 1000) {
        recorder.push(samples(period, 1000));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        status = recorder.status();
      }
      _exit(!status.running && status.error.find("is missing from the recording") != std::string::npos &&
                    status.error.find("cannot be written") != std::string::npos
                ? 42
                : 1);
    }
    int result = 0;
    waitpid(child, &result, 0);
    CHECK(WIFEXITED(result));
    CHECK(WEXITSTATUS(result) == 42);
    check_broke_off(file);
  }
}

TEST_CASE("a recording that cannot be begun leaves no file") {
  const TemporaryDirectory directory;
  for (const char* name : {"a.h5", "a.csv"}) {
    CAPTURE(name);
    const auto file = directory / name;
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{1000, 1000};
      setrlimit(RLIMIT_FSIZE, &limit);
      const auto what = message_of<device::Error>([&] { Recorder(file, about()); });
      _exit(what.find("cannot be written") != std::string::npos ? 42 : 1);
    }
    int result = 0;
    waitpid(child, &result, 0);
    CHECK(WIFEXITED(result));
    CHECK(WEXITSTATUS(result) == 42);
    CHECK_FALSE(fs::exists(file));
  }
}

TEST_CASE("a file that is no recording, or a damaged one, is refused with a sentence") {
  const TemporaryDirectory directory;
  CHECK(error_of(directory / "none.h5").find("none.h5") != std::string::npos);
  std::ofstream(directory / "text.h5") << "hello";
  CHECK(error_of(directory / "text.h5").find("not a recording") != std::string::npos);
  {
    Recorder recorder(directory / "whole.h5", about());
    recorder.push(samples(0, 20'000));
  }
  std::ifstream whole(directory / "whole.h5", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  std::ofstream(directory / "cut.h5", std::ios::binary) << bytes.substr(0, 600);
  CHECK(error_of(directory / "cut.h5").find("damaged") != std::string::npos);

  std::ofstream(directory / "a.csv") << "# inkwell recording = 1\ntime_s,force_N\n0.00005,1.5\n0.0001,oops\n";
  CHECK(error_of(directory / "a.csv").find("line 4") != std::string::npos);
  for (const char* time : {"nan", "-1", "1000000001", "1e300"}) {
    std::ofstream(directory / "a.csv") << "# inkwell recording = 1\ntime_s,force_N\n" << time << ",1.5\n";
    CHECK(error_of(directory / "a.csv").find("line 3: ") != std::string::npos);
    CHECK(error_of(directory / "a.csv").find("is not a valid board time") != std::string::npos);
  }
  std::ofstream(directory / "b.csv") << "# something else = 1\ntime_s,force_N\n0.00005,1.5\n";
  CHECK_FALSE(error_of(directory / "b.csv").empty());
}

TEST_CASE("numbers of a CSV that do not fit are left out and named, or as if they were not there") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.csv") << "# inkwell recording = 1\n# protocol_version = 65536\n# mark 5025 = knock\n"
                                        "# mark 20000000000001 = too late\n# mark -1 = too early\n"
                                        "time_s,force_N\n0.25,1\n214748.36475,2\n1000000000,3\n";
  const Recording recording = read(directory / "a.csv");
  CHECK(recording.information.protocol_version == 0);
  REQUIRE(recording.marks.size() == 1);
  CHECK(recording.marks[0].period == 5025);
  REQUIRE(recording.remarks.size() == 2);
  CHECK(recording.remarks[0].find("\"too late\"") != std::string::npos);
  CHECK(recording.remarks[1].find("\"too early\"") != std::string::npos);
  CHECK(recording.periods == std::vector<std::int64_t>{5000, 4294967295, 20'000'000'000'000});
}

TEST_CASE("the time of a recording continues across the wrap of the board counter, in both formats") {
  const TemporaryDirectory directory;
  constexpr std::int64_t wrap = std::int64_t{1} << 32;
  for (const char* name : {"a.h5", "a.csv"}) {
    CAPTURE(name);
    Recorder recorder(directory / name, about());
    recorder.push(samples(wrap - 300, 250));
    recorder.push(samples(wrap - 50, 100));
    recorder.push(samples(wrap + 60, 50));
    recorder.note({device::EventKind::force, "off", "", wrap + 20});
    const auto status = recorder.stop();
    CHECK(status.error.empty());
    CHECK(status.lost == 10);
    CHECK(status.duration_s == doctest::Approx(409 / 20'000.0));
    const Recording recording = read(directory / name);
    REQUIRE(recording.size() == 400);
    CHECK(recording.lost() == 10);
    CHECK(recording.periods.front() == wrap - 300);
    CHECK(recording.periods.back() == wrap + 109);
    CHECK(std::ranges::is_sorted(recording.periods));
    REQUIRE(recording.marks.size() == 1);
    CHECK(recording.marks[0].period == wrap + 20);
  }
}

TEST_CASE("the time of an earlier recording version continues where its periods fall at the counter wrap") {
  const TemporaryDirectory directory;
  constexpr std::int64_t wrap = std::int64_t{1} << 32;
  SUBCASE("CSV") {
    std::ofstream(directory / "old") << "# inkwell recording = 1\ntime_s,force_N\n214748.36470,1\n214748.36475,2\n"
                                        "# mark 1 = knock\n0.00000,3\n0.00005,4\n# complete = 1\n";
  }
  SUBCASE("HDF5") {
    Recorder(directory / "old.h5", about()).push(samples(wrap - 2, 4));
    write_as_32_bits(directory / "old.h5", "/period", {0xFFFF'FFFE, 0xFFFF'FFFF, 0, 1});
    fs::rename(directory / "old.h5", directory / "old");
  }
  const Recording recording = read(directory / "old");
  CHECK(recording.periods == std::vector<std::int64_t>{wrap - 2, wrap - 1, wrap, wrap + 1});
  CHECK(recording.lost() == 0);
  CHECK(recording.duration_s() == doctest::Approx(3 / 20'000.0));
  for (const auto& mark : recording.marks) CHECK(mark.period == wrap + 1);
}

TEST_CASE("a parameter that is newer than the recording has its default") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.csv") << "# inkwell recording = 1\n# parameter wall_stiffness_N_per_m = 432.5\n"
                                        "time_s,force_N\n0.00005,1.5\n";
  const auto parameters = read(directory / "a.csv").information.parameters;
  CHECK(parameters[Parameter::wall_stiffness_N_per_m] == 432.5f);
  CHECK(parameters[Parameter::force_limit_N] == protocol::default_parameters()[Parameter::force_limit_N]);
}

TEST_CASE("marks of a recording without samples have no time") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.csv") << "# inkwell recording = 1\n# mark 5025 = knock\ntime_s,force_N\n";
  const Recording recording = read(directory / "a.csv");
  REQUIRE(recording.marks.size() == 1);
  CHECK(recording.elapsed_s_at(recording.marks[0].period) == 0.0);
  CHECK(log_text(recording).find("knock") != std::string::npos);
}

TEST_CASE("a file from a newer version is read as far as it is known, and remarks name the rest") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.csv") << "# inkwell recording = 99\n# parameter wobble_m = 3\n"
                                        "time_s,force_N,wobble_N,duty_1\n0.00005,1.5,9,0.25\n";
  const auto recording = read(directory / "a.csv");
  CHECK(recording.remarks.size() == 3);
  REQUIRE(recording.size() == 1);
  CHECK(recording.column(Signal::force_N)[0] == 1.5f);
  CHECK(recording.column(Signal::duty_1)[0] == 0.25f);
}
