#include "cli/run_program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <sstream>
#include <system_error>

extern char** environ;

namespace kinebase::test {
namespace {

void Check(int error, const char* what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

// Two ends: the program writes into one, the test reads from the other.
class Channel {
 public:
  explicit Channel(bool is_terminal) { is_terminal ? OpenTerminal() : OpenPipe(); }
  ~Channel() {
    ::close(read_);
    CloseWriteEnd();
  }
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  [[nodiscard]] int read_end() const { return read_; }
  [[nodiscard]] int write_end() const { return write_; }
  void CloseWriteEnd() {
    if (write_ >= 0) ::close(write_);
    write_ = -1;
  }

 private:
  void OpenPipe() {
    std::array<int, 2> ends{};
    Check(::pipe2(ends.data(), O_CLOEXEC) == 0 ? 0 : errno, "pipe");
    read_ = ends[0];
    write_ = ends[1];
  }

  void OpenTerminal() {
    read_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    Check(read_ >= 0 && ::grantpt(read_) == 0 && ::unlockpt(read_) == 0 ? 0 : errno, "terminal");
    std::array<char, 128> name{};
    Check(::ptsname_r(read_, name.data(), name.size()), "terminal");
    write_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    Check(write_ >= 0 ? 0 : errno, name.data());
  }

  int read_ = -1;
  int write_ = -1;
};

// Reads both until both have ended: a program that fills one would otherwise wait for ever.
void ReadAll(const Channel& out, std::string& out_text, const Channel& err, std::string& err_text) {
  std::array<pollfd, 2> waiting = {{{out.read_end(), POLLIN, 0}, {err.read_end(), POLLIN, 0}}};
  const std::array<std::string*, 2> texts = {&out_text, &err_text};
  while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
    Check(::poll(waiting.data(), waiting.size(), -1) >= 0 ? 0 : errno, "poll");
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      if (waiting[i].revents == 0) continue;
      std::array<char, 65536> buffer{};
      const ssize_t count = ::read(waiting[i].fd, buffer.data(), buffer.size());
      if (count > 0) {
        texts[i]->append(buffer.data(), static_cast<std::size_t>(count));
      } else {
        waiting[i].fd = -1;  // The end; a terminal says EIO.
      }
    }
  }
}

class FileActions {
 public:
  FileActions() { Check(::posix_spawn_file_actions_init(&actions_), "spawn"); }
  ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  posix_spawn_file_actions_t* get() { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

std::vector<std::string> Environment(const std::map<std::string, std::string>& changes) {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    const std::string name = text.substr(0, text.find('='));
    if (name != "NO_COLOR" && !changes.contains(name)) variables.push_back(text);
  }
  for (const auto& [name, value] : changes) {
    variables.push_back(name);
    variables.back().append("=").append(value);
  }
  return variables;
}

std::vector<char*> Pointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

nlohmann::ordered_json ProgramResult::Json() const {
  auto json = nlohmann::ordered_json::parse(out, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << "no JSON: " << out << err;
  return json.is_discarded() ? nlohmann::ordered_json() : json;
}

std::vector<std::string> ProgramResult::ErrorLines() const {
  std::vector<std::string> lines;
  std::istringstream text(err);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

bool HasTerminals() {
  try {
    const Channel terminal(true);
    return true;
  } catch (const std::system_error&) {
    return false;
  }
}

ProgramResult RunCommand(const std::vector<std::string>& arguments, const RunOptions& options) {
  Channel out(false);
  Channel err(options.on_terminal);
  FileActions actions;
  if (options.out_file.empty()) {
    Check(::posix_spawn_file_actions_adddup2(actions.get(), out.write_end(), 1), "spawn");
  } else {
    Check(::posix_spawn_file_actions_addopen(actions.get(), 1, options.out_file.c_str(),
                                             O_WRONLY | O_CREAT, 0666),
          "spawn");
  }
  Check(::posix_spawn_file_actions_adddup2(actions.get(), err.write_end(), 2), "spawn");
  Check(::posix_spawn_file_actions_addopen(actions.get(), 0, "/dev/null", O_RDONLY, 0), "spawn");
  if (!options.folder.empty()) {
    Check(::posix_spawn_file_actions_addchdir_np(actions.get(), options.folder.c_str()), "spawn");
  }
  std::vector<std::string> argument_texts = arguments;
  std::vector<std::string> variables = Environment(options.environment);
  pid_t child = 0;
  Check(::posix_spawnp(&child, argument_texts.front().c_str(), actions.get(), nullptr,
                       Pointers(argument_texts).data(), Pointers(variables).data()),
        arguments.front().c_str());
  out.CloseWriteEnd();
  err.CloseWriteEnd();
  ProgramResult result;
  ReadAll(out, result.out, err, result.err);
  int status = 0;
  Check(::waitpid(child, &status, 0) == child ? 0 : errno, "waitpid");
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

ProgramResult RunKinebase(std::vector<std::string> arguments, const RunOptions& options) {
  arguments.insert(arguments.begin(), KINEBASE_PROGRAM);
  return RunCommand(arguments, options);
}

}  // namespace kinebase::test
