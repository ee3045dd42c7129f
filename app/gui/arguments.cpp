// SPDX-License-Identifier: Apache-2.0
#include "app/gui/arguments.h"

#include <QCommandLineParser>

#include <string>

#include "core/base/error.h"

namespace beam {
namespace {

[[noreturn]] void refuse(const QString& words) { throw Error(Error::Kind::Usage, words.toStdString()); }

double numberOf(const QCommandLineParser& parser, const QString& name) {
  bool good = false;
  const double value = parser.value(name).toDouble(&good);
  if (!good) refuse(QString("--%1 expects a number, found \"%2\"").arg(name, parser.value(name)));
  return value;
}

QString shownIds() {
  QStringList ids;
  for (const ChannelInfo& channel : shownChannels()) ids << QString::fromStdString(channel.id);
  return ids.join(", ");
}

void readLook(const QCommandLineParser& parser, StudioArguments& a) {
  a.look_given = parser.isSet("theme") || parser.isSet("text-size");
  if (parser.isSet("theme")) {
    const QStringList names{"system", "dark", "light"};  // in the order of Theme
    const int theme = static_cast<int>(names.indexOf(parser.value("theme")));
    if (theme < 0) refuse("--theme expects system, dark or light, found \"" + parser.value("theme") + "\"");
    a.theme = static_cast<Theme>(theme);
  }
  if (!parser.isSet("text-size")) return;
  a.text_percent = static_cast<int>(numberOf(parser, "text-size"));
  if (a.text_percent < 100 || a.text_percent > 150)
    refuse("--text-size expects a percentage from 100 to 150, found " + parser.value("text-size"));
}

}  // namespace

StudioArguments parseArguments(QCoreApplication& application) {
  QCommandLineParser parser;
  parser.setApplicationDescription("BEAM Studio: multi-view photographs in, relightable Gaussians out.");
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument("PATH", "A capture folder or a project, Name.beam.", "[CAPTURE|P.beam]");
  const auto add = [&](const char* name, const char* help, const char* value = nullptr,
                       const char* otherwise = "") {
    parser.addOption(value ? QCommandLineOption(name, help, value, otherwise)
                           : QCommandLineOption(name, help));
  };
  add("view", "View to start with: splat, image or scene.", "NAME", "splat");
  add("channel", ("Channel of the splat view: one of " + shownIds() + ".").toUtf8().constData(), "NAME",
      kRelightChannel);
  add("camera", "Camera to look through.", "NAME");
  add("frame", "Frame to show, by the capture's name.", "NAME");
  add("environment", "Panorama to light with.", "FILE");
  add("yaw", "Turn of the light in degrees.", "DEG", "0");
  add("photo", "Opacity of the photograph over the camera's render, 0 to 1.", "SHARE");
  add("sky", "Show the panorama behind the subject.");
  add("mesh", "Show the mesh alone in the scene view, without ellipsoids and seed points.");
  add("a", "Picture A of the image view: photo, mask, render.CHANNEL or map.NAME.", "ID");
  add("b", "Picture B, under a wipe.", "ID");
  add("stage", "Stage whose settings are shown.", "NAME");
  add("run", "Start a run.");
  add("scope",
      "Frames of that run: frame (the shown one), range (from in to out point), scout (every Kth of the "
      "range) "
      "or take.",
      "NAME", "frame");
  add("every", "K of a scout run.", "K", std::to_string(kScoutEvery).c_str());
  add("until", "Last stage of that run.", "STAGE");
  add("wait-run", "Take the screenshot only when the run has ended.");
  add("in", "In point of the timeline, a frame by the capture's name.", "NAME");
  add("out", "Out point of the timeline.", "NAME");
  add("curve", "Curve below the timeline's lanes: STEP.SCORE, such as surface.fit.seconds.", "NAME");
  add("play", "Play that many seconds and print the rate that was reached.", "S");
  add("full-size", "Full-size pictures while playing, too.");
  add("frame-memory", "Most memory that decoded frames may take; 0: 2000 or a quarter of the machine's.",
      "MB", "0");
  add("screenshot",
      "Write the window as a PNG file and quit, with the layout as it ships; for reviews without a "
      "person (works under xvfb-run).",
      "FILE");
  add("theme", "Colours: system, dark or light; otherwise as chosen last in the window.", "NAME");
  add("text-size", "Text in percent of its usual size, 100 to 150; otherwise as chosen last.", "PERCENT");
  add("after", "Seconds to wait before the screenshot, once everything is shown.", "S", "0");
  add("simd", "auto, avx512, avx2 or scalar.", "NAME", "auto");
  add("threads", "Threads to use; 0: all.", "N", "0");
  parser.process(application);

  StudioArguments a;
  if (parser.positionalArguments().size() > 1)
    refuse("one capture or project is expected, found " + parser.positionalArguments().join(", "));
  if (!parser.positionalArguments().isEmpty()) a.path = parser.positionalArguments().front();
  const auto view = studioViewNamed(parser.value("view").toStdString());
  if (!view) refuse("--view expects splat, image or scene, found \"" + parser.value("view") + "\"");
  a.view = *view;
  const ChannelInfo* channel = findChannel(parser.value("channel").toStdString());
  if (!channel || channel->key == 0)
    refuse("--channel expects one of " + shownIds() + ", found \"" + parser.value("channel") + "\"");
  a.channel = *channel;
  a.camera = parser.value("camera");
  a.frame = parser.value("frame");
  a.environment = parser.value("environment");
  a.left = parser.value("a");
  a.right = parser.value("b");
  a.select = parser.value("stage");
  a.screenshot = parser.value("screenshot");
  a.until = parser.value("until");
  a.yaw_deg = numberOf(parser, "yaw");
  a.after_s = numberOf(parser, "after");
  if (parser.isSet("photo")) a.photo = numberOf(parser, "photo");
  a.sky = parser.isSet("sky");
  a.mesh = parser.isSet("mesh");
  a.run = parser.isSet("run");
  const auto scope = runScopeNamed(parser.value("scope").toStdString());
  if (!scope) refuse("--scope expects frame, range, scout or take, found \"" + parser.value("scope") + "\"");
  a.scope = *scope;
  a.every = static_cast<int>(numberOf(parser, "every"));
  if (a.every < 1) refuse("--every expects a number of frames, 1 or more");
  a.in = parser.value("in");
  a.out = parser.value("out");
  a.curve = parser.value("curve");
  if (parser.isSet("play")) a.play_s = numberOf(parser, "play");
  a.full_size = parser.isSet("full-size");
  a.frame_memory_mb = numberOf(parser, "frame-memory");
  if (a.play_s < 0 || a.frame_memory_mb < 0) refuse("--play and --frame-memory expect no negative number");
  readLook(parser, a);
  a.wait_run = parser.isSet("wait-run");
  a.device.simd = parser.value("simd").toStdString();
  a.device.threads = static_cast<int>(numberOf(parser, "threads"));
  return a;
}

}  // namespace beam
