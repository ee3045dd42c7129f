// SPDX-License-Identifier: Apache-2.0
#include "core/base/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/eventfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/error.h"

namespace beam {
namespace {

constexpr std::size_t kMostErrorText = 64 * 1024;
constexpr int kPipeBytes = 1 << 20;  // the most that Linux gives everybody
constexpr auto kBetweenChecks = std::chrono::milliseconds(50);

[[noreturn]] void refuse(std::string_view doing, int reason) {
  throw Error(reason == ENOMEM ? Error::Kind::OutOfMemory : Error::Kind::Storage,
              fmt::format("cannot {}: {}; close other programs and try again", doing, std::strerror(reason)));
}

class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() { close(); }
  int get() const { return fd_; }
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

 private:
  int fd_;
};

// Above the standard three, over which the child's ends are laid.
Descriptor aboveStandard(Descriptor given) {
  if (given.get() > 2) return given;
  Descriptor high(::fcntl(given.get(), F_DUPFD_CLOEXEC, 3));
  if (high.get() < 0) refuse("make a stream to another program", errno);
  return high;
}

struct Ends {
  Descriptor reads, writes;
};

Ends newPipe() {
  int fds[2];
  if (::pipe2(fds, O_CLOEXEC) != 0) refuse("make a stream to another program", errno);
  Descriptor reads(fds[0]), writes(fds[1]);
  return {aboveStandard(std::move(reads)), aboveStandard(std::move(writes))};
}

// Our end: the other end of a pipe is a description of its own and still waits.
void neverWait(const Descriptor& end) {
  if (::fcntl(end.get(), F_SETFL, O_NONBLOCK) != 0) refuse("make a stream to another program", errno);
}

// A write into a pipe that nobody reads any more also sends the thread a signal, which would end this
// program.
ssize_t writeWithoutSignal(int fd, std::span<const std::byte> bytes) {
  sigset_t pipe, before, pending;
  ::sigemptyset(&pipe);
  ::sigaddset(&pipe, SIGPIPE);
  ::sigpending(&pending);
  ::pthread_sigmask(SIG_BLOCK, &pipe, &before);
  const ssize_t n = ::write(fd, bytes.data(), bytes.size());
  const int reason = errno;
  if (n < 0 && reason == EPIPE && !::sigismember(&pending, SIGPIPE)) {
    const timespec at_once{};
    while (::sigtimedwait(&pipe, nullptr, &at_once) < 0 && errno == EINTR) {
    }
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = reason;
  return n;
}

class SpawnPlan {
 public:
  SpawnPlan() {
    int failed = ::posix_spawn_file_actions_init(&actions_);
    if (failed == 0) failed = ::posix_spawnattr_init(&attributes_);
    if (failed != 0) refuse("start another program", failed);
  }
  ~SpawnPlan() {
    ::posix_spawnattr_destroy(&attributes_);
    ::posix_spawn_file_actions_destroy(&actions_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  void standard(int number, const Descriptor& end) {
    check(::posix_spawn_file_actions_adddup2(&actions_, end.get(), number));
  }
  void discarded(int number) {
    check(::posix_spawn_file_actions_addopen(&actions_, number, "/dev/null", O_WRONLY, 0));
  }
  // Libraries open files without close-on-exec.
  void nothingElse() { check(::posix_spawn_file_actions_addclosefrom_np(&actions_, 3)); }

  pid_t start(const std::string& program, const std::vector<std::string>& words) {
    sigset_t all, none;
    ::sigfillset(&all);
    ::sigemptyset(&none);
    check(::posix_spawnattr_setsigdefault(&attributes_, &all));
    check(::posix_spawnattr_setsigmask(&attributes_, &none));
    check(::posix_spawnattr_setpgroup(&attributes_, 0));
    check(::posix_spawnattr_setflags(&attributes_,
                                     POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP));
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_t pid = 0;
    const int failed =
        ::posix_spawn(&pid, program.c_str(), &actions_, &attributes_, arguments.data(), environ);
    if (failed != 0) refuse(fmt::format("start \"{}\"", program), failed);
    return pid;
  }

 private:
  static void check(int failed) {
    if (failed != 0) refuse("start another program", failed);
  }

  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

bool isProgram(const std::string& path) {
  std::error_code out_of_reach;
  return std::filesystem::is_regular_file(path, out_of_reach) && ::access(path.c_str(), X_OK) == 0;
}

std::string programOf(const std::vector<std::string>& words) {
  if (words.empty()) throw Error(Error::Kind::Bug, "a program to start has a name");
  const std::string& name = words.front();
  if (name.find('/') == std::string::npos) {
    if (const std::optional<std::string> found = installedProgram(name)) return *found;
    throw Error(
        Error::Kind::Usage,
        fmt::format("the program {} is not in the folders of PATH; install it, or add its folder", name));
  }
  if (isProgram(name)) return name;
  throw Error(Error::Kind::Usage, fmt::format("\"{}\" is no program that can be started", name));
}

}  // namespace

std::optional<std::string> installedProgram(const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos) return std::nullopt;
  const char* set = std::getenv("PATH");
  std::string_view folders = set ? set : "/usr/bin:/bin";
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(std::min(folder.size() + 1, folders.size()));
    const std::string path = fmt::format("{}/{}", folder, name);
    if (folder.starts_with('/') && isProgram(path)) return path;
  }
  return std::nullopt;
}

struct ChildProcess::State {
  ~State() {
    input.close();
    if (over.get() >= 0) ::eventfd_write(over.get(), 1);
    if (listener.joinable()) listener.join();
    if (reaper.joinable()) reaper.join();
  }

  void start(const std::vector<std::string>& words, Output kept);
  void listen();
  void awaitEnd();
  void send(int signal_number) const {
    if (::kill(-pid, signal_number) != 0) ::kill(pid, signal_number);  // it left its group
  }
  bool waitFor(const Descriptor& end, short event, const Progress* progress) const;
  std::size_t readSome(const Descriptor& end, std::span<std::byte> bytes, const Progress* progress) const;

  Descriptor input, output, errors;
  Descriptor over;  // can be read once the program has ended
  pid_t pid = 0;

  mutable std::mutex mutex;
  std::condition_variable changed;
  bool stopped = false, ended = false, heard = false;
  int exit_code = 0;
  std::string error_text;

  std::thread listener, reaper;
};

void ChildProcess::State::start(const std::vector<std::string>& words, Output kept) {
  const std::string program = programOf(words);
  Ends in = newPipe(), err = newPipe(), out;
  SpawnPlan plan;
  plan.standard(0, in.reads);
  if (kept == Output::Kept) {
    out = newPipe();
    plan.standard(1, out.writes);
    neverWait(out.reads);
    ::fcntl(out.reads.get(), F_SETPIPE_SZ, kPipeBytes);  // fewer turns; less will do
  } else {
    plan.discarded(1);
  }
  plan.standard(2, err.writes);
  plan.nothingElse();
  neverWait(in.writes);
  neverWait(err.reads);
  ::fcntl(in.writes.get(), F_SETPIPE_SZ, kPipeBytes);
  over = Descriptor(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (over.get() < 0) refuse("make a stream to another program", errno);
  input = std::move(in.writes);
  output = std::move(out.reads);
  errors = std::move(err.reads);

  listener = std::thread([this] { listen(); });
  pid = plan.start(program, words);
  try {
    reaper = std::thread([this] { awaitEnd(); });
  } catch (...) {
    send(SIGKILL);
    ::waitpid(pid, nullptr, 0);
    throw;
  }
}

// Whether the program has ended. Returns when the stream is ready or that is so.
bool ChildProcess::State::waitFor(const Descriptor& end, short event, const Progress* progress) const {
  std::array<pollfd, 2> what = {pollfd{end.get(), event, 0}, pollfd{over.get(), POLLIN, 0}};
  for (;;) {
    if (progress) progress->check();
    const int ready =
        ::poll(what.data(), what.size(), progress ? static_cast<int>(kBetweenChecks.count()) : -1);
    if (ready > 0) return what[1].revents != 0;
    if (ready < 0 && errno != EINTR) refuse("wait for another program", errno);
  }
}

std::size_t ChildProcess::State::readSome(const Descriptor& end, std::span<std::byte> bytes,
                                          const Progress* progress) const {
  for (;;) {
    const bool has_ended = waitFor(end, POLLIN, progress);
    const ssize_t n = ::read(end.get(), bytes.data(), bytes.size());
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno != EAGAIN && errno != EINTR) refuse("read from another program", errno);
    if (errno == EAGAIN && has_ended) return 0;  // what it started may still hold the stream
  }
}

void ChildProcess::State::listen() {
  std::array<std::byte, 16384> bytes;
  std::size_t after_the_end = 0;
  while (after_the_end <= kPipeBytes) {
    std::size_t n = 0;
    try {
      n = readSome(errors, bytes, nullptr);
    } catch (const Error&) {  // what it has to say is lost, what it does is not
    }
    const std::lock_guard lock(mutex);
    if (n == 0) break;
    if (ended) after_the_end += n;
    error_text.append(reinterpret_cast<const char*>(bytes.data()), n);
    if (error_text.size() > 2 * kMostErrorText) error_text.erase(0, error_text.size() - kMostErrorText);
  }
  errors.close();
  const std::lock_guard lock(mutex);
  heard = true;
  changed.notify_all();
}

void ChildProcess::State::awaitEnd() {
  siginfo_t end{};
  const auto wait = [&](int how) {
    int failed;
    do failed = ::waitid(P_PID, static_cast<id_t>(pid), &end, how);
    while (failed != 0 && errno == EINTR);
    return failed == 0;
  };
  wait(WEXITED | WNOWAIT);
  // Its number is another's once it is waited for: nobody sends signals meanwhile, and none later.
  const std::lock_guard lock(mutex);
  if (stopped) ::kill(-pid, SIGKILL);  // what it started
  const bool known = wait(WEXITED);
  exit_code = !known ? 255 : end.si_code == CLD_EXITED ? end.si_status : 128 + end.si_status;
  ended = true;
  ::eventfd_write(over.get(), 1);
  changed.notify_all();
}

ChildProcess::ChildProcess(const std::vector<std::string>& words, Output output)
    : state_(std::make_unique<State>()) {
  try {
    state_->start(words, output);
  } catch (const std::system_error& no_thread) {
    refuse("start a thread beside another program", no_thread.code().value());
  }
}

ChildProcess::~ChildProcess() { stop(); }

bool ChildProcess::write(std::span<const std::byte> bytes, const Progress* progress) {
  State& s = *state_;
  while (!bytes.empty()) {
    if (s.input.get() < 0 || s.waitFor(s.input, POLLOUT, progress)) return false;
    const ssize_t n = writeWithoutSignal(s.input.get(), bytes);
    if (n < 0 && errno == EPIPE) return false;
    if (n < 0 && errno != EAGAIN && errno != EINTR) refuse("write to another program", errno);
    if (n > 0) bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

void ChildProcess::closeInput() { state_->input.close(); }

std::size_t ChildProcess::read(std::span<std::byte> bytes, const Progress* progress) {
  if (state_->output.get() < 0) throw Error(Error::Kind::Bug, "output that is discarded cannot be read");
  return state_->readSome(state_->output, bytes, progress);
}

int ChildProcess::finish(const Progress* progress) {
  State& s = *state_;
  s.input.close();
  std::unique_lock lock(s.mutex);
  const auto is_over = [&] { return s.ended && s.heard; };
  while (!s.changed.wait_for(lock, kBetweenChecks, is_over))
    if (progress) progress->check();
  return s.exit_code;
}

void ChildProcess::stop(std::chrono::milliseconds patience) {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  s.stopped = true;
  if (!s.ended && patience.count() > 0) s.send(SIGTERM);
  if (!s.changed.wait_for(lock, patience, [&] { return s.ended; })) s.send(SIGKILL);
  s.changed.wait(lock, [&] { return s.ended && s.heard; });
}

std::string ChildProcess::errorText() const {
  const std::lock_guard lock(state_->mutex);
  const std::string& all = state_->error_text;
  return all.substr(all.size() - std::min(all.size(), kMostErrorText));
}

}  // namespace beam
