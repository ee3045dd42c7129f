// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/project.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/pipeline/lock_reach.h"
#include "core/pipeline/lost_capture.h"
#include "core/pipeline/output_target.h"
#include "core/pipeline/path_kind.h"
#include "core/pipeline/presets.h"
#include "core/pipeline/project_history.h"
#include "core/pipeline/project_merge.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr const char* kDocumentFile = "project.json";

// Whether a project can be made there. What a killed attempt to make one left behind does not count.
bool isFree(const fs::path& folder) {
  if (!isThere(folder)) return true;
  std::error_code failed;
  if (!fs::is_directory(folder, failed)) return false;
  for (const fs::directory_entry& entry : entriesOf(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != "LOCK" && name != "history" && !name.starts_with(".project.json.")) return false;
  }
  return true;
}

}  // namespace

bool Project::isProject(const fs::path& folder) {
  std::error_code failed;
  return isThere(folder / kDocumentFile) && fs::is_regular_file(folder / kDocumentFile, failed);
}

Project::Project(fs::path folder, ProjectDocument document, std::shared_ptr<const PipelineSetup> setup)
    : folder_(std::move(folder)),
      document_(std::move(document)),
      setup_(std::move(setup)),
      store_(std::make_shared<ResultStore>(folder_)),
      inputs_(std::make_shared<InputDigests>()) {}

Project Project::open(const fs::path& folder, std::shared_ptr<const PipelineSetup> setup) {
  if (folder.empty()) throw Error(Error::Kind::Usage, "the project's name is empty; expected Name.beam");
  if (!isProject(folder) && looksLikeProject(folder)) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\" is a project that has lost its project.json; {}",
                                               folder.string(), historyAdvice(folder)));
  }
  std::error_code failed;
  const bool file = fs::exists(folder, failed) && !fs::is_directory(folder, failed);
  if (!isProject(folder) && (file || beam::isCapture(folder))) {
    throw Error(Error::Kind::Data, fmt::format("expected a project, Name.beam; \"{}\" {}", folder.string(),
                                               kindInWords(folder)));
  }
  if (!isProject(folder)) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\" is no project: it has no project.json; make one with: beam new "
                            "\"{}\" --capture FOLDER",
                            folder.string(), folder.string()));
  }
  Project project(folder, readProjectDocument(folder), std::move(setup));
  project.saved_ = std::make_shared<const ProjectDocument>(project.document_);
  project.read_hold_out_ = project.document_.hold_out;
  return project;
}

Project Project::create(const fs::path& folder, const ProjectDocument& document,
                        std::shared_ptr<const PipelineSetup> setup) {
  requireOutside(folder);
  if (!isFree(folder)) {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" exists and is not an empty folder; choose another name for the "
                            "project",
                            folder.string()));
  }
  Project project(folder, document, std::move(setup));
  if (project.document_.id.empty()) project.document_.id = newProjectId();
  project.setPreset(document.preset);  // refuses unknown ones
  return project;
}

std::string Project::name() const {
  const fs::path normal = (folder_ / "").lexically_normal().parent_path();
  return normal.extension() == ".beam" ? normal.stem().string() : normal.filename().string();
}

bool Project::readOnly() const {
  struct stat info {};
  // No write bit at all says "leave it alone" also to root, whom the kernel would let through.
  if (::stat(folder_.c_str(), &info) == 0 && (info.st_mode & 0222) == 0) return true;
  return ::access(folder_.c_str(), W_OK) != 0;
}

// --- Settings ---

const std::map<std::string, FieldValue>& Project::preset() const {
  if (preset_loaded_ != document_.preset) {
    try {
      preset_ = setup_->presets.empty() ? std::map<std::string, FieldValue>{}
                                        : loadPreset(setup_->presets, document_.preset);
    } catch (const Error& e) {
      if (e.kind() != Error::Kind::Usage) throw;
      throw Error(Error::Kind::Data,
                  fmt::format("\"{}\": {}; choose one with beam run \"{}\" --preset NAME",
                              (folder_ / kDocumentFile).string(), e.what(), folder_.string()));
    }
    preset_loaded_ = document_.preset;
  }
  return preset_;
}

std::unique_ptr<Stage> Project::makeStage(std::string_view stage) const {
  std::unique_ptr<Stage> made = setup_->stages.make(stage);
  for (const auto* values : {&preset(), &document_.settings}) setSaved(*made, stage, *values);
  return made;
}

void Project::setSaved(Stage& stage, std::string_view stage_id,
                       const std::map<std::string, FieldValue>& from) const {
  const bool own = &from == &document_.settings;
  const auto refuse = [&](const std::string& key, const std::string& why) {
    const std::string where = own ? fmt::format("\"{}\"", (folder_ / kDocumentFile).string())
                                  : fmt::format("the preset {}", document_.preset);
    const std::string advice =
        own ? fmt::format("; beam run \"{}\" --unset {} takes it out", folder_.string(), key) : "";
    throw Error(Error::Kind::Data, fmt::format("{}: {}{}", where, why, advice));
  };
  const std::string prefix = std::string(stage_id) + ".";
  for (const auto& [key, value] : from) {
    if (!key.starts_with(prefix)) continue;
    FieldSetter setter(key.substr(prefix.size()), value);
    try {
      stage.parameters(setter);
    } catch (const Error& e) {
      refuse(key, prefix + e.what());
    }
    if (!setter.found) refuse(key, fmt::format("there is no setting {}", key));
  }
}

std::vector<Field> Project::fields() const {
  return setup_->stages.allFields([this](std::string_view stage) { return makeStage(stage); });
}

FieldValue Project::value(std::string_view key) const {
  std::vector<std::string> names;
  for (const Field& field : fields()) {
    if (field.info.name == key) return field.value;
    names.push_back(field.info.name);
  }
  throw Error(Error::Kind::Usage, noSuchName("setting", key, names, "beam stages lists them"));
}

FieldValue Project::presetValue(std::string_view key) const {
  Project plain = *this;
  plain.document_.settings.clear();
  return plain.value(key);
}

void Project::set(std::string_view key, const FieldValue& wanted) {
  const FieldValue preset_value = presetValue(key);  // refuses unknown keys
  const std::size_t dot = key.find('.');             // known: it has one
  const std::string_view stage_id = key.substr(0, dot), name = key.substr(dot + 1);
  std::unique_ptr<Stage> stage = setup_->stages.make(stage_id);
  try {
    FieldSetter setter(std::string(name), wanted);
    stage->parameters(setter);
  } catch (const Error& e) {
    throw Error(e.kind(), fmt::format("{}.{}", stage_id, e.what()));
  }
  FieldList list;
  stage->parameters(list);
  for (const Field& field : list.fields) {
    if (field.info.name != name) continue;
    memo_.clear();
    if (field.value == preset_value) {
      document_.settings.erase(std::string(key));
    } else {
      document_.settings[std::string(key)] = field.value;
    }
  }
}

void Project::reset(std::string_view key) {
  document_.settings.erase(std::string(key));
  memo_.clear();
}

void Project::setPreset(const std::string& name) {
  if (!setup_->presets.empty()) loadPreset(setup_->presets, name);
  document_.preset = name;
  memo_.clear();
  // What the new preset says anyway no longer differs.
  for (const auto& [key, value] : std::map(document_.settings)) set(key, value);
}

std::vector<std::string> Project::presetNames() const { return presetNamesIn(setup_->presets); }

void Project::setCapture(const fs::path& capture) {
  if (document_.capture.absolute.empty()) finds_placement_ = true;
  document_.capture = referenceTo(capture, folder_);
  document_.capture_files = describeCapture(capture);
  without_capture_ = false;
  forgetCapture();
}

void Project::setEnvironment(const std::optional<fs::path>& file) {
  if (file) {
    document_.environment = referenceTo(*file, folder_);
  } else {
    document_.environment.reset();
  }
  memo_.clear();
}

void Project::setHoldOut(std::vector<std::string> hold_out) {
  document_.hold_out = std::move(hold_out);
  forgetCapture();
}

void Project::setUp(std::optional<UpAxis> up) {
  document_.up = up;
  forgetCapture();
}

const Look* Project::look(std::string_view name) const {
  const auto found = std::find_if(document_.looks.begin(), document_.looks.end(),
                                  [&](const Look& look) { return look.name == name; });
  return found == document_.looks.end() ? nullptr : &*found;
}

void Project::setLook(const Look& look) {
  if (!isLookName(look.name)) {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" cannot name a look: expected 1 to 100 characters without / and \\, not "
                            "beginning with a dot",
                            look.name));
  }
  validate(look);
  const auto same = std::find_if(document_.looks.begin(), document_.looks.end(),
                                 [&](const Look& l) { return l.name == look.name; });
  if (same != document_.looks.end()) {
    *same = look;
    return;
  }
  if (document_.looks.size() >= kMostLooks) {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" has {} looks, which is as many as there can be: remove one first",
                            folder_.string(), kMostLooks));
  }
  document_.looks.push_back(look);
}

void Project::removeLook(std::string_view name) {
  std::erase_if(document_.looks, [&](const Look& look) { return look.name == name; });
}

Project Project::withSettingsOf(const ProjectDocument& earlier, bool takes_too) const {
  Project copy = sketch();
  ProjectDocument& d = copy.document_;
  const bool other_import =
      d.hold_out != earlier.hold_out || d.up != earlier.up || d.world != earlier.world || finds_placement_;
  d.preset = earlier.preset;
  d.settings = earlier.settings;
  d.environment = earlier.environment;
  d.hold_out = earlier.hold_out;
  d.up = earlier.up;
  d.world = earlier.world;
  if (takes_too) setTakes(d, takesOf(earlier));
  copy.finds_placement_ = false;
  copy.unit_m_.reset();
  if (other_import) copy.forgetCapture();
  return copy;
}

void Project::setUnit(double unit_m) {
  const std::optional<CapturePlacement>& known = document_.world;
  if (known && known->from == UnitFrom::Given && known->unit_m == unit_m && !finds_placement_) return;
  finds_placement_ = true;
  unit_m_ = unit_m;
  forgetCapture();
}

std::optional<CapturePlacement> Project::world() const {
  return finds_placement_ && !without_capture_ ? imported().placement : document_.world;
}

void Project::forgetCapture() {
  imported_.reset();
  memo_.clear();
}

bool Project::save() {
  document_.world = world();
  if (finds_placement_) document_.world_unknown = "{}";
  finds_placement_ = finds_placement_ && without_capture_;
  requireSavable(folder_, document_);
  if (!isProject(folder_)) requireSharedLocks(folder_);  // before there is a folder
  std::error_code failed;
  fs::create_directories(folder_, failed);
  if (failed) {
    throw Error(Error::Kind::Storage,
                fmt::format("cannot make the project folder \"{}\": {}", folder_.string(), failed.message()));
  }
  if (const std::optional<ProjectDocument> disk = savedDocument(folder_)) {
    ProjectDocument wanted = saved_ ? merged(*saved_, document_, *disk).document : document_;
    setTakes(wanted, takesOf(*disk));
    if (toJson(wanted) == toJson(*disk)) return takeOver(std::move(wanted));
  }
  if (readOnly()) {
    throw Error(Error::Kind::Storage,
                fmt::format("\"{}\" is read-only: the changed settings cannot be saved; make the "
                            "folder writable or copy it",
                            folder_.string()));
  }
  ProjectDocument document = document_;
  writeProjectDocument(folder_, document, saved_.get());
  return takeOver(std::move(document));
}

// What other programs wrote is in it, takes too.
bool Project::takeOver(ProjectDocument document) {
  const auto ofCapture = [](const ProjectDocument& d) {
    return std::tie(d.capture, d.capture_files, d.hold_out, d.up, d.world);
  };
  const bool same_capture = ofCapture(document) == ofCapture(document_);
  setTakes(document_, takesOf(document));
  const bool others = toJson(document) != toJson(document_);
  document_ = std::move(document);
  saved_ = std::make_shared<const ProjectDocument>(document_);
  memo_.clear();
  if (!same_capture) forgetCapture();
  return others;
}

// --- Capture ---

fs::path Project::captureFolder() const {
  if (std::optional<fs::path> found = resolve(document_.capture, folder_)) return *found;
  throw Error(
      Error::Kind::Data,
      fmt::format("{}; its results are kept, and which of them are in force hangs on the capture: put it "
                  "back, or name its new place with: beam process FOLDER --out \"{}\" --until capture",
                  lostCaptureText(), folder_.string()));
}

std::string Project::lostCaptureText() const {
  return fmt::format("the capture of \"{}\" is gone: expected it at \"{}\"", folder_.string(),
                     document_.capture.absolute);
}

bool Project::captureIsThere() const {
  const std::optional<fs::path> found = resolve(document_.capture, folder_);
  std::error_code failed;
  return found && fs::is_directory(*found, failed);
}

void Project::lookWithoutCapture() {
  without_capture_ = true;
  forgetCapture();
}

void Project::requireCapture() const {
  if (!without_capture_) return;
  captureFolder();  // says so when it is still gone
  throw Error(Error::Kind::Data, fmt::format("\"{}\" was opened without its capture, which is there again: "
                                             "open the project once more",
                                             folder_.string()));
}

std::string Project::differenceOfCapture(const fs::path& folder) const {
  const std::vector<DescriptionFile> found = describeCapture(folder);
  if (found.empty()) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\" is no capture: expected dataset.json, transforms.json or sparse/ in it",
                            folder.string()));
  }
  return differenceOf(document_.capture_files, found);
}

std::string Project::captureChange() const {
  return document_.capture_files.empty() ? std::string() : differenceOfCapture(captureFolder());
}

void Project::acceptCaptureChange() { document_.capture_files = describeCapture(captureFolder()); }

void Project::relocateCapture(const fs::path& folder, bool other_too) {
  const std::string other = differenceOfCapture(folder);
  if (!other_too && !other.empty()) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\" is another capture than that of \"{}\", which was at \"{}\": {}",
                            folder.string(), folder_.string(), document_.capture.absolute, other));
  }
  // Another capture may have another unit.
  if (!other.empty() && document_.world && document_.world->from != UnitFrom::Given) finds_placement_ = true;
  setCapture(folder);
}

bool Project::isCapture(const fs::path& folder) const {
  std::error_code failed;
  const std::optional<fs::path> own = resolve(document_.capture, folder_);
  if (own && fs::equivalent(*own, folder, failed)) return true;
  return !document_.capture_files.empty() && describeCapture(folder) == document_.capture_files;
}

const ImportedCapture& Project::imported() const {
  if (!imported_ && without_capture_) {
    imported_ = std::make_shared<const ImportedCapture>(captureFromResults(*this));
  } else if (!imported_) {
    ImportOptions options;
    options.up = document_.up;
    options.hold_out = document_.hold_out;
    options.unit_m = unit_m_;
    if (!finds_placement_) options.placement = document_.world.value_or(CapturePlacement{});
    try {
      imported_ = std::make_shared<const ImportedCapture>(setup_->open_capture(captureFolder(), options));
    } catch (const Error& e) {
      if (e.kind() != Error::Kind::Usage || read_hold_out_ != document_.hold_out) throw;
      throw Error(Error::Kind::Data,
                  fmt::format("\"{}\" does not fit its capture: {}; say it anew with beam run \"{}\" "
                              "--hold-out",
                              (folder_ / kDocumentFile).string(), e.what(), folder_.string()));
    }
  }
  return *imported_;
}

std::optional<fs::path> Project::environmentFile() const {
  if (!document_.environment) {
    const std::optional<std::string>& own = capture().environment_file;
    return own ? std::optional<fs::path>(*own) : std::nullopt;
  }
  if (std::optional<fs::path> found = resolve(*document_.environment, folder_)) return found;
  throw Error(
      Error::Kind::Data,
      fmt::format("the panorama of \"{}\" is gone: expected it at \"{}\"; put it back or name another with "
                  "--environment FILE, or in the studio by File > Light of the capture",
                  folder_.string(), document_.environment->absolute));
}

const InputDigests& Project::inputs() const { return *inputs_; }

}  // namespace beam
