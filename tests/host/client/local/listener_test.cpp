// Tests sockets for programs on this computer: access rights and removal of the socket files.
#include <doctest/doctest.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "host/client/device/socket.hpp"
#include "host/client/local/listener.hpp"
#include "host/client/local/private_folder.hpp"
#include "tests/environment.hpp"
#include "tests/failure.hpp"
#include "tests/plain_client.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using local::Listener;
using local::SocketAddress;

namespace {

namespace fs = std::filesystem;

std::string refusal(const SocketAddress& where) {
  return message_of<std::runtime_error>([&] { Listener listener(where, "--test"); });
}

mode_t mode_of(const fs::path& file) {
  struct stat status {};
  REQUIRE(::lstat(file.c_str(), &status) == 0);
  return status.st_mode & 07777;
}

/// Creates a socket file in a program that exits without removing the file.
void leave_behind(const fs::path& path) {
  const pid_t child = fork();
  if (child == 0) {
    new Listener({.path = path}, "--test");
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  REQUIRE(fs::is_socket(path));
}

}  // namespace

TEST_CASE("only its user can connect to a Unix socket, and the socket is removed with its listener") {
  const TemporaryDirectory directory;
  const fs::path path = directory / "socket";
  const mode_t mask = ::umask(0);
  {
    const Listener listener({.path = path}, "--test");
    CHECK(mode_of(path) == 0600);
    CHECK(listener.address().text() == "unix:" + path.string());
    CHECK(local::connect_to(path).is_open());
  }
  ::umask(mask);
  CHECK(fs::is_empty(directory.path()));
}

TEST_CASE("a listener replaces a socket of an exited program and no other file") {
  const TemporaryDirectory directory;
  const fs::path path = directory / "socket";
  leave_behind(path);
  {
    const Listener listener({.path = path}, "--test");
    CHECK(contains(refusal({.path = path}), "another program listens there"));
    CHECK(local::connect_to(path).is_open());
  }
  std::ofstream(path) << "precious";
  CHECK(contains(refusal({.path = path}), "not a socket"));
  CHECK(fs::file_size(path) == 8);
  fs::remove(path);
  fs::create_symlink("elsewhere", path);
  CHECK(contains(refusal({.path = path}), "not a socket"));
  CHECK(fs::is_symlink(path));
}

TEST_CASE("a socket of another program that took the name stays") {
  const TemporaryDirectory directory;
  const fs::path path = directory / "socket";
  std::optional<Listener> first(std::in_place, SocketAddress{.path = path}, "--test");
  fs::remove(path);
  const Listener second({.path = path}, "--test");
  first.reset();
  CHECK(local::connect_to(path).is_open());
}

TEST_CASE("a socket is refused in a folder that other users can change") {
  const TemporaryDirectory directory;
  for (const auto others : {fs::perms::others_write, fs::perms::group_write}) {
    fs::permissions(directory.path(), fs::perms::owner_all | others);
    const std::string sentence = refusal({.path = directory / "socket"});
    CHECK(contains(sentence, "--test: unix:"));
    CHECK(contains(sentence, "other users may change its folder"));
  }
  fs::permissions(directory.path(), fs::perms::all | fs::perms::sticky_bit);  // mode of /tmp
  CHECK(refusal({.path = directory / "socket"}).empty());
  CHECK(contains(refusal({.path = directory / "nowhere/socket"}), "folder does not exist"));
}

TEST_CASE("a TCP port is found, and a second listener is refused with its option and number") {
  const Listener listener({}, "--test");
  CHECK(listener.address().port != 0);
  CHECK(listener.address().text() == "127.0.0.1:" + std::to_string(listener.address().port));
  const std::string sentence = refusal(listener.address());
  CHECK(contains(sentence, "--test: " + listener.address().text()));
  CHECK(contains(sentence, "another program listens there"));
}

TEST_CASE("the path of a socket can be written in a line, and is not too long for the system") {
  CHECK(local::unix_socket("unix:/run/a").path == "/run/a");
  for (const std::string& wrong : {std::string("unix:"), std::string("unix:/tmp/a b"), std::string("unix:/tmp/\n"),
                                   "unix:/" + std::string(107, 'x')})
    CHECK_THROWS_AS(local::unix_socket(wrong), local::BadSocketAddress);
  const std::string longest = "/" + std::string(106, 'x');
  CHECK(local::unix_socket("unix:" + longest).path == longest);
}

TEST_CASE("a private folder lies in the user's runtime folder, or where there is a safe one, and is removed") {
  const TemporaryDirectory directory;
  fs::path path;
  {
    const Environment runtime("XDG_RUNTIME_DIR", directory.path());
    const auto folder = local::PrivateFolder::for_sockets();
    path = folder.path();
    CHECK(path.parent_path() == directory.path());
    CHECK(mode_of(path) == 0700);
  }
  CHECK_FALSE(fs::exists(path));
  fs::permissions(directory.path(), fs::perms::all);
  for (const std::string& unsafe :
       {directory.path(), std::string("relative"), std::string("/nowhere"), directory.path() + "/a b"}) {
    const Environment runtime("XDG_RUNTIME_DIR", unsafe), temporary("TMPDIR", unsafe);
    CHECK(local::PrivateFolder::for_sockets().path().parent_path() == "/tmp");
  }
}

TEST_CASE("a program listens on the IPv6 address of this computer, and a client connects to the printed address") {
  std::optional<Listener> listener;
  try {
    listener.emplace(SocketAddress{.host = "::1"}, "--test");
  } catch (const std::runtime_error&) {
    MESSAGE("skipped: this computer has no IPv6");
    return;
  }
  CHECK(listener->address().text() == fmt::format("[::1]:{}", listener->address().port));
  CHECK_NOTHROW(device::Socket(local::parse_socket_address(listener->address().text())));
}
