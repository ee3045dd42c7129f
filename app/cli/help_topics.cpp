// SPDX-License-Identifier: Apache-2.0
#include "app/cli/help_topics.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "app/cli/exit_codes.h"
#include "app/cli/help_page.h"
#include "app/cli/json_keys.h"
#include "core/base/field_text.h"
#include "core/scene/camera_track.h"
#include "core/scene/channel.h"
#include "core/scene/look.h"
#include "core/scene/scene_document.h"
#include "core/work/export_frames.h"

namespace beam {
namespace {

std::string formText(const ChannelInfo& channel) {
  switch (channel.file) {
    case FileForm::Png:
      return "PNG, 8 bit";
    case FileForm::Ply:
      return "PLY, one file a frame, no camera in its path";
    case FileForm::HalfExr:
    case FileForm::FloatExr:
      break;
  }
  return fmt::format("EXR, {} float, {}", channel.file == FileForm::HalfExr ? "half" : "32 bit",
                     componentsOf(channel) == 3 ? "channels R G B" : "one channel Y");
}

std::string contentText(const ChannelInfo& channel) {
  switch (channel.quantity) {
    case Quantity::Color:
      return channel.file == FileForm::Png ? "sRGB, no tone curve" : "linear Rec.709";
    case Quantity::Direction:
      return "unit x y z in the axes of --frame-of";
    case Quantity::Length:
      return "along the optical axis, in the unit of --frame-of (world: metres)";
    case Quantity::Scalar:
      if (channel.needs == ChannelNeeds::Mesh) return "in the axes and the unit of --frame-of";
      return channel.unit.empty() ? "from 0 to 1" : channel.unit;
  }
  return {};
}

std::string edgeText(const ChannelInfo& channel) {
  if (channel.file == FileForm::Ply) return {};
  if (channel.times_alpha) return "; value x alpha, on black";
  const float least = channel.least_alpha;
  if (least <= 0) return {};
  return least >= 0.1f ? fmt::format("; 0 where alpha is below {:.1f}", least)
                       : fmt::format("; 0 where alpha is below 1/{:.0f}", std::round(1 / least));
}

std::string channelText(const ChannelInfo& channel) {
  std::string text =
      fmt::format("{}. {}: {}{}.", channel.title, formText(channel), contentText(channel), edgeText(channel));
  if (needsMaterials(channel)) text += " Needs Materials.";
  if (channel.needs == ChannelNeeds::MaterialsAndLight) text += " Needs --environment FILE.";
  if (channel.needs == ChannelNeeds::MaterialsAndLight && channel.id != kRelightChannel)
    text += " Of --renderer reference.";
  return text;
}

// As folders are named.
std::string folderText(const ChannelInfo& channel) {
  return channel.id == kRelightChannel ? fmt::format("{}_<panorama>", channel.id) : channel.id;
}

std::string filesText() {
  HelpPage page(20);
  page.paragraph("What the program writes, and where. Nothing is written into a capture.");
  page.heading("Pictures of beam render");
  page.paragraph(
      "OUT/<channel>/<camera>/<frame>.<png|exr>; meshes OUT/mesh/<frame>.ply. A frame is named as "
      "in the capture, <panorama> is the file name of the light without its ending.",
      2);
  page.blank();
  for (const ChannelInfo& channel : channels()) page.row(folderText(channel), channelText(channel));
  page.row("look_<name>",
           "In place of channels, with --look: as the look's view transform says, PNG with what is behind or "
           "straight alpha, or EXR, half float, R G B A, premultiplied. Of a camera that moves "
           "look_<name>/<path>/000000.png and on, and the film look_<name>/<path>.mp4. See beam help looks.");
  page.blank();
  page.paragraph(
      "Every other EXR has either R, G and B or one channel Y, without layers, so that every reader takes "
      "it. Values are never divided by alpha. With --layers a camera and frame have one linear EXR, "
      "OUT/layers/<camera>/<frame>.exr: R G B A of rgb, and a layer a channel, such as base_color.R, "
      "ao.Y, normal.X, depth.Z, relight_<panorama>.R.",
      2);
  page.heading("Exports of beam export");
  for (const ExportFormat& format : exportFormats())
    page.row(
        fmt::format("--format {}", format.id),
        fmt::format("{}: OUT/frame.000000.{}, the capture's frame number in six digits; the frame's name "
                    "where frames have no numbers of their own",
                    format.help, format.extension));
  page.heading("A project, Name.beam");
  page.row("project.json", "the capture's place, the settings that differ from the preset, looks");
  page.row("history/", "the last versions of project.json, twenty of them");
  page.row("results/",
           "one folder a result: plain PLY, EXR, PNG and JSON that other programs open, and "
           "result.json, which says what it was made of");
  page.row("failures/", "why a frame failed, for beam status");
  page.row("evaluation.json", "and evaluation_frames.json: what beam evaluate found last");
  page.row("logs/",
           "a text file a run, named by its beginning in UTC and its process, such as "
           "20260314T081500Z-4711.log: every step, warning and error with its time, of beam and of the "
           "window alike; the last twenty are kept");
  page.row("leases/, LOCK", "who computes what; processes may share a project");
  page.heading("Files that are there already");
  page.paragraph(
      "A file is replaced where the same command wrote it; another is refused with exit code 2 "
      "unless --force is given.",
      2);
  return page.text();
}

std::string capturesText() {
  HelpPage page(20);
  page.paragraph(
      "A capture is a folder of photographs of one subject, taken by calibrated cameras that stand still. It "
      "is only read. beam check FOLDER says what is understood of it, beam sample FOLDER makes a small one "
      "to look at.");
  page.heading("What lies in it");
  page.row("dataset.json", "or transforms.json or sparse/0/: the cameras, see below");
  page.row("images/", "a folder a camera, a file a frame: images/cam00/000000.png; PNG or JPEG");
  page.row("masks/",
           "if any, as the images: masks/cam00/000000.png, white where the subject is. mask/, mattes/ and "
           "alpha/ are read too, and 000000_mask.png or 000000_alpha.png beside a picture");
  page.row("environment.exr", "or environment.hdr, if any: the light, see beam help environment");
  page.row("points3D.ply", "if any: points of the subject, to start from");
  page.blank();
  page.paragraph(
      "Without masks, the alpha channel of the pictures counts, or an even black or white ground up to their "
      "borders; else nothing is cut out. Without a panorama a run stops after Surface. Files of one frame "
      "have the same name in every camera; a picture that is missing is left out with a warning.",
      2);
  page.heading("The cameras: the first of these that is there");
  page.row(
      "dataset.json",
      "\"cameras\": by name width, height, fx, fy, cx, cy, R and t (camera from world, OpenCV axes), and "
      "\"split\": \"train\" or \"test\". If known \"fps\" and \"world\": {\"up\": \"+Z\", \"unit\": "
      "\"m\"}");
  page.row("transforms.json",
           "as of NeRF, instant-ngp and nerfstudio: \"frames\" with \"file_path\", if any \"mask_path\", and "
           "\"transform_matrix\" (world from camera, OpenGL axes); fl_x or camera_angle_x; test_filenames "
           "and ply_file_path if any");
  page.row("sparse/0/",
           "a COLMAP model, binary or text, of SIMPLE_PINHOLE or PINHOLE cameras; also in sparse/, "
           "colmap/sparse/0/ or the folder itself. An image is named camera/frame.png, or camera alone for a "
           "folder of frames, or is a file alone: one frame");
  page.blank();
  page.paragraph(
      "At least two training cameras are needed, without lens distortion: undistort the pictures first. "
      "Every picture has the size that its camera is calibrated for. Axes come from the description or the "
      "cameras, else from --up; the unit from the description or the subject's height, else from --unit. "
      "--hold-out keeps cameras for testing.",
      2);
  return page.text();
}

std::string exitCodesText() {
  HelpPage page(4);
  page.paragraph(
      "What the program ends with; a script can rely on it. What went wrong is on standard error, in a "
      "line that starts with \"error:\".");
  page.blank();
  for (const ExitCodeInfo& e : exitCodes()) {
    page.row(fmt::format("{}", e.code), e.meaning);
    if (*e.advice) page.row("", fmt::format("What to do: {}", e.advice));
  }
  return page.text();
}

std::string environmentText() {
  HelpPage page(16);
  page.paragraph("Two things have this name: variables of the shell, and panoramas of the light.");
  page.heading("Environment variables");
  page.row("NO_COLOR", "set to anything: no colours in messages");
  page.row("TERM", "\"dumb\" or not set: plain lines instead of a bar, no colours");
  page.row("XDG_STATE_HOME",
           "where it keeps how long steps took on this machine, for run --dry-run; else "
           "~/.local/state");
  page.row(
      "BEAM_LOCAL_LOCKS",
      "1: write to a project on a network disk whose locks other machines do not see (exit code 69 else), "
      "while none of them works in it");
  page.row("PATH", "where ffmpeg is looked for, which films are written with");
  page.row("TMPDIR", "where beam evaluate puts pictures for a moment; else /tmp");
  page.blank();
  page.paragraph(
      "The width of a line is asked of the terminal itself, not of COLUMNS. Everything else is said "
      "with flags and settings: what is not typed does not change a result.",
      2);
  page.heading("Panoramas of the light (--environment FILE)");
  page.paragraph(
      "A latitude-longitude picture in OpenEXR (.exr) or Radiance (.hdr), linear Rec.709, twice as "
      "wide as high. Its values are radiance; they are used as they are, the light has gain 1.",
      2);
  page.blank();
  page.row("top row", "+Y, up");
  page.row("centre", "+Z");
  page.row("a quarter", "of the width from the left: +X");
  page.row("u", "0.5 - atan2(x, z) / 2 pi, from the left edge");
  page.row("v", "0.5 - asin(y) / pi, from the top edge");
  page.blank();
  page.paragraph(
      "These are the axes of the world (right-handed, +Y up, metres), and those of OpenEXR and USD. In a "
      "capture "
      "with +Z up, x, y and z of the world are Y, Z and X of the capture; the same turn takes Blender's "
      "panoramas "
      "(centre +X, +Z up) onto ours pixel for pixel, so that such a panorama needs no turn.",
      2);
  page.blank();
  page.paragraph(
      "beam check FILE says where the brightest direction is. process, new and run keep the panorama "
      "as the light of the photographs; render takes one to relight with.",
      2);
  return page.text();
}

std::string framesText() {
  HelpPage page(20);
  page.paragraph("How frames and cameras are chosen. Numbers are those in the capture's own file names.");
  page.heading("Frames (--frames LIST)");
  page.row("5", "one frame");
  page.row("0-7", "frames 0 to 7; both must be there, gaps are the capture's own");
  page.row("1-", "from 1 to the last");
  page.row("1-9x2", "every second from 1 to 9: 1, 3, 5, 7, 9");
  page.row("1,5,10-12", "several, with commas");
  page.row("all", "all; render, evaluate and export: all that are solved");
  page.row("frame_0003", "a frame by its name");
  page.heading("Takes");
  page.paragraph(
      "Frames that follow each other are solved as a take: each builds on the one before, which is "
      "faster and steadier. Every run of consecutive numbers in LIST is a take of its own, and a "
      "number that stands alone is fitted alone. A run without --frames takes the whole capture.",
      2);
  page.blank();
  page.paragraph(
      "--every K solves every Kth frame, each built on the one K before, for a first look; render and "
      "export interpolate those between and say so.",
      2);
  page.heading("Cameras (--cameras LIST)");
  page.row("test", "those held out, by the capture's description or --hold-out");
  page.row("train", "the others, which the fit saw");
  page.row("all", "both");
  page.row("cam03", "a camera by its name");
  page.row("'cam0*'",
           "names by a pattern: * is any letters, ? is one; quote it, so that the shell leaves it alone");
  page.row("test,cam03,'top*'", "several, with commas; each camera once");
  page.blank();
  page.paragraph(
      "--hold-out 8 keeps every 8th camera for testing, --hold-out cam02,cam07 these, --hold-out none "
      "none. A camera that is held out is never used for fitting.",
      2);
  return page.text();
}

void fieldRows(const std::vector<Field>& fields, HelpPage& page) {
  for (const Field& f : fields) {
    const std::string value = toText(f.value);
    std::string expected = expectedText(f.info, f.value);
    if (!expected.empty())
      expected[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(expected[0])));
    page.row(f.info.name,
             fmt::format("{} {}; else {}.", f.info.help, expected, value.empty() ? "empty" : value));
  }
}

std::string looksText() {
  HelpPage page(26);
  page.paragraph(
      "A look says how a subject is lit and shown: a panorama, lamps, exposure, what is behind. It is a JSON "
      "file, or one of the project's by its name; beam render P.beam --look NAME|FILE draws it into "
      "OUT/look_<name>/<camera>/<frame>.png, or .exr (R G B A, premultiplied) where view_transform is raw. "
      "What a file does not say is as it is listed here behind \"else\".");
  page.heading("A small one");
  page.paragraph(
      "{\"format\": {\"name\": \"beam-look\", \"major\": 1, \"minor\": 0}, \"name\": \"key\", "
      "\"environment\": "
      "{\"gain\": 0.3}, \"lights\": [{\"id\": \"sun\", \"kind\": \"directional\", \"azimuth_deg\": 60, "
      "\"elevation_deg\": 40}]}",
      2);
  page.blank();
  page.paragraph(
      "A dot in a name stands for an object inside: {\"environment\": {\"file\": {\"relative\": "
      "\"sunset.exr\"}}}. Files are named relative to the look's own file, or absolutely: one of the two is "
      "enough. What is misspelt is kept, has no effect and is warned of. Directions are those of the world: "
      "azimuth 0 is +Z, 90 is +X; beam help environment has the axes. The transforms aces and agx are kept "
      "and not drawn.",
      2);
  page.heading("Of the look");
  fieldRows(fieldsOf(Look{}), page);
  for (const std::string& kind : lightKinds()) {
    page.heading(fmt::format("Of a light of the kind {}, beside its id", kind));
    fieldRows(fieldsOf(newLight("light", kind)), page);
  }
  page.heading("Over time");
  page.paragraph(
      "\"curves\" drives numbers and switches by their paths, lights.sun.intensity or "
      "environment.rotation_deg: {\"keys\": [{\"time_s\": 0, \"value\": 0}, {\"time_s\": 2, \"value\": "
      "90}]}. "
      "Parts of a place are numbers as well: lights.sun.position_m.x. A key may have \"easing\": linear, "
      "smooth or "
      "step, on the way to the next. A frame has the time of its place in the capture over the rate, a "
      "picture of a film its own.",
      2);
  page.heading("Films (--camera-path)");
  page.row("turntable", "once around the subject in --duration, from the first of --cameras");
  page.row("FILE",
           "keys of a camera, which goes through them: {\"format\": {\"name\": \"beam-camera-path\", "
           "\"major\": 1, \"minor\": 0}, \"keys\": [{\"time_s\": 0, \"position_m\": {\"x\": 0, "
           "\"y\": 1.5, \"z\": 3}, \"target_m\": {\"x\": 0, \"y\": 1, \"z\": 0}}, ...]}");
  page.row("none", "the cameras stand, though the look has a path");
  page.blank();
  page.paragraph(
      "Pictures are OUT/look_<name>/<path>/000000.png and on, the film is OUT/look_<name>/<path>.mp4 (H.264, "
      "by the installed program ffmpeg; without it there are the pictures alone). The take plays at its own "
      "rate, to and fro until the time is over; one frame stands.",
      2);
  page.heading("Of a key of a camera");
  fieldRows(fieldsOf(CameraKey{}), page);
  page.heading("Scenes");
  page.paragraph(
      "--look takes a scene file, too: {\"format\": {\"name\": \"beam-scene\", \"major\": 1, \"minor\": 0}, "
      "\"performances\": [{\"project\": {\"relative\": \"Other.beam\"}, \"scene_from_performance\": "
      "{\"translation_m\": {\"x\": 1}}}], \"look\": {...}}. Its projects lie relative to it; cameras and "
      "times "
      "are those of PROJECT; a performance plays its own frames at its own times. Its rotation is three rows "
      "of a "
      "matrix. Meshes (PLY) and the ground are drawn by --renderer reference alone.",
      2);
  page.heading("Of a performance");
  fieldRows(fieldsOf(Performance{}), page);
  page.heading("Of a mesh");
  fieldRows(fieldsOf(SceneMesh{}), page);
  page.heading("Of the ground");
  fieldRows(fieldsOf(Ground{}), page);
  return page.text();
}

std::string settingsText() {
  HelpPage page(22);
  page.paragraph(
      "Settings have names like surface.iterations: the stage, then the setting. beam stages lists "
      "every one with its default, its range, its meaning and what each preset says; beam stages P.beam the "
      "values in force in a project and where each comes from.");
  page.heading("Where a value comes from");
  page.row("1. the default", "the paper's number");
  page.row("2. the preset",
           "draft (a look in a minute), standard (when nothing is said), paper (the paper's numbers); "
           "it says what differs from the defaults");
  page.row("3. the project", "what was set with --set; project.json keeps it until it is taken back");
  page.heading("Flags of process, new and run");
  page.row("--preset NAME", "the preset of the project; what was set by name stays");
  page.row("--set KEY=VALUE",
           "a setting; several times for several. VALUE is a number, true, false or a word");
  page.row("--unset KEY", "take a setting back to what the preset says");
  page.row("--reset", "take all settings back to what the preset says");
  page.blank();
  page.paragraph(
      "An unknown name, a wrong type or a value out of range is refused before anything is computed or "
      "saved. What is set counts for this run and those after it.",
      2);
  page.heading("What is computed again");
  page.paragraph(
      "A result is kept under the settings it was made with. After a change, only steps that the setting "
      "reaches are computed again; taking it back finds the earlier results. Until then render, "
      "export, evaluate and report use the last settings that were solved, and say what changed since; "
      "--strict refuses. beam clean removes what no setting in force needs. Settings that cost time or "
      "memory alone change no result.",
      2);
  return page.text();
}

std::string jsonText() {
  HelpPage page(34);
  page.paragraph(
      "What --json prints on standard output and --json-file writes. An object begins with "
      "written_by.program, "
      "the command. Names that are data are shown as *, elements of a list as []; a key that has nothing "
      "to say is left out. Further keys may come.");
  page.blank();
  page.paragraph("beam run --json prints an object a line while it runs: one an event.");
  for (const JsonAnswer& answer : jsonAnswers()) {
    page.heading(fmt::format("beam {}", answer.command));
    for (const JsonKey& key : answer.keys) page.row(key.path, key.meaning);
  }
  return page.text();
}

}  // namespace

const std::vector<HelpTopic>& helpTopics() {
  static const std::vector<HelpTopic> all = {
      {"captures", "what the folder of a capture looks like, and what is read", capturesText},
      {"files", "what render and export write, and what a project holds", filesText},
      {"frames", "how frames and cameras are chosen; takes", framesText},
      {"looks", "light, lamps, exposure and background of render --look", looksText},
      {"settings", "--set, --preset, and where values come from", settingsText},
      {"environment", "variables of the shell; axes of panoramas of the light", environmentText},
      {"json", "keys of what --json prints", jsonText},
      {"exit-codes", "what the program ends with", exitCodesText},
  };
  return all;
}

}  // namespace beam
