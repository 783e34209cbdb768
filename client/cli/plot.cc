#include "client/cli/plot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/cli/output.h"
#include "core/numerics/decimal.h"

namespace ricochet::cli {
namespace {

constexpr int kHeight = 620;
constexpr int kWidthOfOne = 960;
constexpr int kWidthOfSeveral = 640;

// Okabe and Ito's colours, which the colour-blind can tell apart, without the yellow.
constexpr char kStyle[] = R"(set linetype 1 linecolor rgb '#0072B2'
set linetype 2 linecolor rgb '#D55E00'
set linetype 3 linecolor rgb '#009E73'
set linetype 4 linecolor rgb '#CC79A7'
set linetype 5 linecolor rgb '#56B4E9'
set linetype 6 linecolor rgb '#E69F00'
set linetype 7 linecolor rgb '#000000'
set linetype cycle 7
set grid linetype 1 linecolor rgb '#d8d8d8' linewidth 1
set autoscale fix
set offsets graph 0, graph 0, graph 0.04, graph 0.04
)";

// Returns a gnuplot string, in which only the quote is a special character.
std::string Quoted(const std::string& text) {
  return absl::StrCat("'", absl::StrReplaceAll(text, {{"'", "''"}, {"\n", " "}}), "'");
}

std::string Terminal(const std::string& terminal, const Plot& plot) {
  const auto panels = static_cast<int>(plot.panels.size());
  const int width = panels == 1 ? kWidthOfOne : kWidthOfSeveral * panels;
  const std::string size =
      absl::StrCat(plot.width > 0 ? plot.width : width, ",", plot.height > 0 ? plot.height : kHeight);
  return terminal == "svg" ? absl::StrCat("svg size ", size, " font 'DejaVu Sans,15' background 'white'")
                           : absl::StrCat("pngcairo size ", size, " font 'DejaVu Sans,13'");
}

void AppendData(const std::string& name, const Curve& curve, std::string& script) {
  absl::StrAppend(&script, "$", name, " << EOD\n");
  for (const auto& [x, y] : curve.points) {
    absl::StrAppend(&script, ShortestDecimal(x), " ", ShortestDecimal(y), "\n");
  }
  absl::StrAppend(&script, "EOD\n");
}

void AppendPanel(size_t number, const Panel& panel, std::string& script) {
  for (size_t i = 0; i < panel.curves.size(); ++i) {
    AppendData(absl::StrCat("p", number, "c", i), panel.curves[i], script);
  }
  absl::StrAppend(&script, "set title ", Quoted(panel.title), "\nset xlabel ", Quoted(panel.x_label), "\nset ylabel ",
                  Quoted(panel.y_label), "\n");
  absl::StrAppend(&script, panel.log_x ? "set" : "unset", " logscale x\n");
  absl::StrAppend(&script, panel.curves.size() > 1 ? "set key outside right center reverse Left\n" : "unset key\n");
  absl::StrAppend(&script, "unset arrow\n", panel.settings);
  for (const double mark : panel.x_marks) {
    const std::string x = ShortestDecimal(mark);
    absl::StrAppend(&script, "set arrow from ", x, ", graph 0 to ", x,
                    ", graph 1 nohead dashtype 2 linecolor rgb 'gray40'\n");
  }
  for (size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const std::string style =
        !curve.style.empty() ? curve.style
                             : absl::StrCat("with ", curve.points.size() == 1 ? "points" : "lines", " linewidth 2");
    absl::StrAppend(&script, i == 0 ? "plot " : ", ", "$p", number, "c", i, " using 1:2 ", style,
                    curve.title.empty() ? " notitle" : absl::StrCat(" title ", Quoted(curve.title)));
  }
  absl::StrAppend(&script, "\n");
}

// Writes all of `text` to the pipe and closes it. Returns false if the reader went away.
bool Feed(int pipe, const std::string& text) {
  size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = write(pipe, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) break;
    if (count > 0) done += static_cast<size_t>(count);
  }
  close(pipe);
  return done == text.size();
}

// The environment of this process with a UTF-8 locale: in others gnuplot warns of characters that it cannot write.
class Utf8Environment {
 public:
  Utf8Environment() {
    for (char** variable = environ; *variable != nullptr; ++variable) {
      const std::string text = *variable;
      if (text.rfind("LC_", 0) != 0 && text.rfind("LANG=", 0) != 0) texts_.push_back(text);
    }
    texts_.emplace_back("LC_ALL=C.UTF-8");
    for (std::string& text : texts_) pointers_.push_back(text.data());
    pointers_.push_back(nullptr);
  }
  char* const* get() const { return pointers_.data(); }

 private:
  std::vector<std::string> texts_;
  std::vector<char*> pointers_;
};

// Starts gnuplot with `input` as its standard input and with no signal blocked or ignored. Returns 0 or an errno.
int SpawnGnuplot(int input, pid_t& child) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  sigset_t broken_pipe = none;
  sigaddset(&broken_pipe, SIGPIPE);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &broken_pipe);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string name = "gnuplot";
  char* const arguments[] = {name.data(), nullptr};
  const Utf8Environment environment;
  const int error = posix_spawnp(&child, "gnuplot", &actions, &attributes, arguments, environment.get());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

absl::Status RunGnuplot(const std::string& script) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return absl::ErrnoToStatus(errno, "cannot start gnuplot");
  pid_t child = -1;
  const int error = SpawnGnuplot(ends[0], child);
  close(ends[0]);
  if (error != 0) {
    close(ends[1]);
    if (error != ENOENT) return absl::ErrnoToStatus(error, "cannot start gnuplot");
    return absl::FailedPreconditionError("pictures need gnuplot, which is not installed (Debian: gnuplot-nox)");
  }
  const bool fed = Feed(ends[1], script);
  int result = 0;
  while (waitpid(child, &result, 0) < 0 && errno == EINTR) {
  }
  if (fed && WIFEXITED(result) && WEXITSTATUS(result) == 0) return absl::OkStatus();
  return absl::InternalError("gnuplot failed");
}

}  // namespace

absl::Status CheckPlotPath(const std::string& path) {
  if (absl::EndsWith(path, ".svg") || absl::EndsWith(path, ".png")) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("--plot ", path, ": must end in .svg or .png"));
}

std::string PlotScript(const Plot& plot, const std::string& terminal, const std::string& path) {
  std::string script = absl::StrCat("set encoding utf8\nset terminal ", Terminal(terminal, plot),
                                    "\nset termoption noenhanced\nset output ", Quoted(path), "\n", kStyle,
                                    "set multiplot layout 1,", plot.panels.size(), " title ", Quoted(plot.title), "\n");
  for (size_t i = 0; i < plot.panels.size(); ++i) AppendPanel(i, plot.panels[i], script);
  absl::StrAppend(&script, "unset multiplot\nunset output\n");
  return script;
}

absl::StatusOr<std::string> DrawSvg(const Plot& plot) {
  // The file is never committed, so that it is removed again.
  const absl::StatusOr<AtomicFile> file =
      AtomicFile::Create((std::filesystem::temp_directory_path() / "ricochet.svg").string());
  if (!file.ok()) return file.status();
  if (absl::Status status = RunGnuplot(PlotScript(plot, "svg", file->temporary_path())); !status.ok()) return status;
  std::ifstream stream(file->temporary_path(), std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

absl::Status Draw(const Plot& plot, const std::string& path) {
  absl::StatusOr<AtomicFile> file = AtomicFile::Create(path);
  if (!file.ok()) return file.status();
  const std::string terminal = absl::EndsWith(path, ".svg") ? "svg" : "png";
  if (absl::Status status = RunGnuplot(PlotScript(plot, terminal, file->temporary_path())); !status.ok()) {
    return status;
  }
  return file->Commit();
}

}  // namespace ricochet::cli
