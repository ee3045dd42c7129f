// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/project_document.h"

#define JSON_DIAGNOSTICS 1  // complaints name the member
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <random>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/fields_json.h"
#include "core/base/json_words.h"
#include "core/base/log.h"
#include "core/base/word_list.h"
#include "core/io/file.h"
#include "core/io/look_json.h"
#include "core/pipeline/file_digest.h"
#include "core/pipeline/file_lock.h"
#include "core/pipeline/lock_reach.h"
#include "core/pipeline/project_merge.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMajor = 1, kMinor = 0;
constexpr std::size_t kKept = 20;

Json toJsonValue(const FileReference& reference) {
  return {{"relative", reference.relative}, {"absolute", reference.absolute}};
}

FileReference parseReference(const Json& j) {
  return {j.at("relative").get<std::string>(), j.at("absolute").get<std::string>()};
}

void readCapture(const Json& j, ProjectDocument& document) {
  document.capture = parseReference(j);
  for (const Json& f : j.at("files")) {
    document.capture_files.push_back({f.at("name").get<std::string>(), f.at("bytes").get<std::uint64_t>(),
                                      parseDigest(f.at("xxh3_128").get<std::string>())});
  }
}

// What has no members, null too, would count as an empty one.
void require(bool is_of_type, const char* what, const char* type) {
  if (!is_of_type) throw Error(Error::Kind::Data, fmt::format("{}: expected {}", what, type));
}

int wholeNumber(const Json& j, const char* what) {
  const bool fits = j.is_number_integer() && j.get<std::int64_t>() >= 0 &&
                    j.get<std::int64_t>() <= std::numeric_limits<int>::max();
  require(fits, what, "a whole number, 0 or more");
  return j.get<int>();
}

std::vector<SavedTake> savedTakes(const Json& j, const char* what) {
  require(j.is_array(), what, "a list");
  std::vector<SavedTake> takes;
  for (const Json& take : j) {
    const auto number = [&](const char* name, const char* in_words) {
      return take.contains(name) ? wholeNumber(take[name], in_words) : 0;
    };
    const SavedTake read{take.at("first").get<std::string>(),
                         take.at("last").get<std::string>(),
                         wholeNumber(take.at("step"), "step of a take"),
                         number("lead", "lead of a take"),
                         take.value("cut", false),
                         number("lost_lead", "lost lead of a take")};
    if (read.step < 1 || read.lead < 0) {
      throw Error(
          Error::Kind::Data,
          fmt::format("take {} to {}: expected a step of 1 or more and a lead of 0 or more, found {} and {}",
                      read.first, read.last, read.step, read.lead));
    }
    takes.push_back(read);
  }
  return takes;
}

Json toJsonValue(const std::vector<SavedTake>& takes) {
  Json list = Json::array();
  for (const SavedTake& take : takes) {
    Json saved = {{"first", take.first}, {"last", take.last}, {"step", take.step}};
    if (take.lead > 0) saved["lead"] = take.lead;
    if (take.cut) saved["cut"] = true;
    if (take.lost_lead > 0) saved["lost_lead"] = take.lost_lead;
    list.push_back(std::move(saved));
  }
  return list;
}

Json toJsonValue(const CapturePlacement& p, const std::string& unknown) {
  Json j = {{"unit_m", p.unit_m}, {"origin", {p.origin.x, p.origin.y, p.origin.z}}, {"from", toText(p.from)}};
  if (p.height > 0) j["height"] = p.height;
  const Json others = Json::parse(unknown);
  for (const auto& [key, value] : others.items()) j[key] = value;
  return j;
}

void readWorld(Json j, ProjectDocument& document) {
  CapturePlacement p;
  p.unit_m = j.at("unit_m").get<double>();
  const auto origin = j.at("origin").get<std::array<double, 3>>();
  p.origin = {origin[0], origin[1], origin[2]};
  p.height = j.value("height", 0.0);
  try {
    p.from = parseUnitFrom(j.at("from").get<std::string>());
    validate(p);
  } catch (const Error& e) {
    throw Error(Error::Kind::Data, fmt::format("world: {}", e.what()));
  }
  document.world = p;
  for (const char* known : {"unit_m", "origin", "from", "height"}) j.erase(known);
  document.world_unknown = j.dump();
}

fs::path nextHistoryFile(const fs::path& history) {
  std::vector<fs::path> kept;
  for (const fs::directory_entry& entry : entriesOf(history)) {
    if (isHistoryFile(entry.path())) kept.push_back(entry.path());
  }
  const int last = kept.empty() ? 0 : std::atoi(kept.back().stem().c_str());
  for (std::size_t i = 0; i + kKept <= kept.size(); ++i) fs::remove(kept[i]);
  return history / fmt::format("{:08}.json", last + 1);
}

struct OnDisk {
  std::string text;
  ProjectDocument document;
};

// None: there is no file, or a damaged one, which is to be replaced.
std::optional<OnDisk> onDisk(const fs::path& file) {
  if (!isThere(file)) return std::nullopt;
  try {
    std::string text = readTextFile(file);
    ProjectDocument document = parseProjectDocument(text, file.string());
    return OnDisk{std::move(text), std::move(document)};
  } catch (const Error& e) {
    requireData(e);
    return std::nullopt;
  }
}

bool sameButForLooks(const ProjectDocument& a, const ProjectDocument& b) {
  return toJson(withoutLooks(a)) == toJson(withoutLooks(b));
}

void keepInHistory(const fs::path& project, const std::string& text) {
  try {
    fs::create_directories(project / "history");
    writeFileAtomically(nextHistoryFile(project / "history"), text);
  } catch (const fs::filesystem_error& e) {
    throw storageError(e);
  }
}

// Nothing is written that would be refused when it is read.
void requireReadable(const fs::path& project, const std::string& text) {
  if (text.size() <= kMostTextBytes) return;
  throw Error(
      Error::Kind::Usage,
      fmt::format("\"{}\" cannot be saved: its project.json would have {} bytes, the limit is {}; keep "
                  "looks with many keys in files of their own",
                  project.string(), text.size(), kMostTextBytes));
}

// Two programs may each have added some.
void requireFewLooks(const fs::path& project, const ProjectDocument& document) {
  if (document.looks.size() <= kMostLooks) return;
  throw Error(
      Error::Kind::Usage,
      fmt::format("\"{}\" cannot be saved: with those that another program added it would have {} looks, "
                  "the limit is {}; remove some",
                  project.string(), document.looks.size(), kMostLooks));
}

ProjectDocument documentOf(Json j) {
  ProjectDocument document;
  document.id = j.at("id").get<std::string>();
  readCapture(j.at("capture"), document);
  if (j.contains("environment")) document.environment = parseReference(j["environment"]);
  if (j.contains("hold_out")) document.hold_out = j["hold_out"].get<std::vector<std::string>>();
  if (j.contains("up")) document.up = parseUpAxis(j["up"].get<std::string>());
  if (j.contains("world")) readWorld(j["world"], document);
  document.preset = j.at("preset").get<std::string>();
  require(j.at("settings").is_object(), "settings", "an object");
  for (const auto& [key, value] : j.at("settings").items())
    document.settings[key] = parseFieldValue(value.dump());
  if (j.contains("takes")) document.takes = savedTakes(j["takes"], "takes");
  if (j.contains("earlier_takes")) document.earlier_takes = savedTakes(j["earlier_takes"], "earlier takes");
  if (j.contains("looks")) document.looks = parseLooks(j["looks"].dump());
  for (const char* known : {"format", "id", "capture", "environment", "hold_out", "up", "world", "preset",
                            "settings", "takes", "earlier_takes", "looks"}) {
    j.erase(known);
  }
  document.unknown = j.dump();
  return document;
}

}  // namespace

ProjectDocument withoutLooks(ProjectDocument document) {
  document.looks.clear();
  return document;
}

bool isHistoryFile(const fs::path& file) {
  const std::string number = file.stem().string();
  return file.extension() == ".json" && !number.empty() &&
         number.find_first_not_of("0123456789") == std::string::npos;
}

std::string newProjectId() {
  std::random_device device;
  std::string id;
  for (int i = 0; i < 4; ++i) id += fmt::format("{:08x}", device());
  return id;
}

FileLock lockProject(const fs::path& project) {
  using namespace std::chrono_literals;
  requireSharedLocks(project);
  for (int attempt = 0; attempt < 40; ++attempt) {
    if (std::optional<FileLock> lock = FileLock::tryAcquire(project / "LOCK")) return std::move(*lock);
    std::this_thread::sleep_for(50ms);
  }
  throw Error(Error::Kind::Locked,
              fmt::format("\"{}\" is being written by another program ({}); try again when it is "
                          "done",
                          project.string(), FileLock::holderOf(project / "LOCK")));
}

UpAxis parseUpAxis(std::string_view text) {
  if (text == "+Y" || text == "+y" || text == "Y" || text == "y") return UpAxis::PlusY;
  if (text == "+Z" || text == "+z" || text == "Z" || text == "z") return UpAxis::PlusZ;
  if (text == "-Y" || text == "-y") return UpAxis::MinusY;
  throw Error(Error::Kind::Usage, fmt::format("up axis: expected +Y, +Z or -Y, found \"{}\"", text));
}

std::vector<DescriptionFile> describeCapture(const fs::path& capture) {
  std::vector<DescriptionFile> found;
  for (const char* folder : {"", "sparse", "sparse/0"}) {
    for (const char* name :
         {"dataset.json", "transforms.json", "cameras.bin", "cameras.txt", "images.bin", "images.txt"}) {
      const fs::path file = capture / folder / name;
      std::error_code failed;
      if (!isThere(file) || !fs::is_regular_file(file, failed)) continue;
      found.push_back({(fs::path(folder) / name).generic_string(), fs::file_size(file), digestOfFile(file)});
    }
  }
  return found;
}

std::string differenceOf(const std::vector<DescriptionFile>& expected,
                         const std::vector<DescriptionFile>& found) {
  std::vector<std::string> differences;
  const auto named = [](const std::vector<DescriptionFile>& files, const std::string& name) {
    return std::find_if(files.begin(), files.end(), [&](const auto& f) { return f.name == name; });
  };
  for (const DescriptionFile& file : expected) {
    const auto here = named(found, file.name);
    if (here == found.end()) {
      differences.push_back(file.name + " is missing");
    } else if (here->bytes != file.bytes) {
      differences.push_back(
          fmt::format("{}: expected {} bytes, found {}", file.name, file.bytes, here->bytes));
    } else if (here->digest != file.digest) {
      differences.push_back(
          fmt::format("{}: expected digest {}, found {}", file.name, file.digest.hex(), here->digest.hex()));
    }
  }
  for (const DescriptionFile& file : found) {
    if (!expected.empty() && named(expected, file.name) == expected.end())
      differences.push_back(file.name + " was not there");
  }
  return fmt::format("{}", fmt::join(differences, "; "));
}

std::string toJson(const ProjectDocument& document) {
  Json j;
  j["format"] = {{"major", kMajor}, {"minor", kMinor}};
  j["id"] = document.id;
  j["capture"] = toJsonValue(document.capture);
  j["capture"]["files"] = Json::array();
  for (const DescriptionFile& f : document.capture_files) {
    j["capture"]["files"].push_back({{"name", f.name}, {"bytes", f.bytes}, {"xxh3_128", f.digest.hex()}});
  }
  if (document.environment) j["environment"] = toJsonValue(*document.environment);
  j["hold_out"] = document.hold_out;
  if (document.up) j["up"] = toText(*document.up);
  if (document.world) j["world"] = toJsonValue(*document.world, document.world_unknown);
  j["preset"] = document.preset;
  j["settings"] = Json::object();
  for (const auto& [key, value] : document.settings) {
    std::visit([&, &k = key](const auto& v) { j["settings"][k] = v; }, value);
  }
  if (!document.takes.empty()) j["takes"] = toJsonValue(document.takes);
  if (!document.earlier_takes.empty()) j["earlier_takes"] = toJsonValue(document.earlier_takes);
  if (!document.looks.empty()) j["looks"] = Json::parse(looksToJson(document.looks));
  const Json unknown = Json::parse(document.unknown);
  for (const auto& [key, value] : unknown.items()) j[key] = value;
  std::string text = j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  // Many keys of looks: their blanks alone could make it longer than what is read.
  if (text.size() > kMostTextBytes) text = j.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  return text;
}

ProjectDocument parseProjectDocument(std::string_view json, std::string_view where) {
  const auto broken = [&](const std::string& why) {
    return BrokenDocument(fmt::format("\"{}\" is broken: {}", where, why));
  };
  if (json.find_first_not_of(" \t\r\n") == std::string_view::npos) throw broken("it is empty");
  int major = 0;
  try {
    Json j = Json::parse(json, shallowJson<Json>);
    major = j.at("format").at("major").get<int>();
    if (major <= kMajor) return documentOf(std::move(j));
  } catch (const nlohmann::json::exception& e) {
    throw broken(jsonComplaint(e));
  } catch (const Error& e) {
    throw broken(e.what());
  }
  throw Error(
      Error::Kind::Data,
      fmt::format("\"{}\" has project format {}.x, this program reads up to {}.x; open it with a newer "
                  "BEAM Studio",
                  where, major, kMajor));
}

void requireSavable(const fs::path& project, const ProjectDocument& document) {
  std::vector<std::string> words = document.hold_out;
  words.insert(words.end(), {document.capture.absolute, document.capture.relative});
  if (document.environment) words.push_back(document.environment->absolute);
  for (const std::string& word : words) {
    if (isUtf8(word)) continue;
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" cannot be saved: the name \"{}\" is no UTF-8, which project.json is "
                            "written in; rename that file or folder",
                            project.string(), word));
  }
}

std::optional<ProjectDocument> savedDocument(const fs::path& project) {
  std::optional<OnDisk> disk = onDisk(project / "project.json");
  return disk ? std::optional(std::move(disk->document)) : std::nullopt;
}

void writeProjectDocument(const fs::path& project, ProjectDocument& document, const ProjectDocument* base) {
  const FileLock lock = lockProject(project);
  const std::optional<OnDisk> disk = onDisk(project / "project.json");
  if (disk && base) {
    MergedDocument both = merged(*base, document, disk->document);
    document = std::move(both.document);
    if (!both.both.empty()) {
      logWarning("\"{}\" was changed by another program meanwhile, too; what is set here holds of {}",
                 project.string(), shortList(both.both));
    }
  }
  if (disk) setTakes(document, takesOf(disk->document));
  const std::string text = toJson(document);
  if (disk && disk->text == text) return;
  requireReadable(project, text);
  requireFewLooks(project, document);
  // The copy first, so that none is missing; of a new project last, for a folder with a copy alone is one
  // that has lost its project.json.
  if (disk && !sameButForLooks(disk->document, document)) {
    // By what is replaced now its results are found later; somebody may have emptied the folder.
    if (entriesOf(project / "history").empty()) keepInHistory(project, disk->text);
    keepInHistory(project, text);
  }
  writeFileAtomically(project / "project.json", text);
  if (!disk) keepInHistory(project, text);
}

SavedTakes takesOf(const ProjectDocument& document) { return {document.takes, document.earlier_takes}; }

void setTakes(ProjectDocument& document, SavedTakes takes) {
  document.takes = std::move(takes.now);
  document.earlier_takes = std::move(takes.earlier);
}

SavedTakes changeSavedTakes(const fs::path& project, const ChangeTakes& change) {
  const fs::path file = project / "project.json";
  const auto read = [&] { return parseProjectDocument(readTextFile(file), file.string()); };
  SavedTakes seen = takesOf(read());
  if (change(seen) == seen) return seen;
  const FileLock lock = lockProject(project);
  ProjectDocument document = read();
  SavedTakes changed = change(takesOf(document));
  if (changed == takesOf(document)) return changed;
  setTakes(document, changed);
  // No copy in history/: that is for what people change, and a run may change takes many times.
  const std::string text = toJson(document);
  requireReadable(project, text);
  writeFileAtomically(file, text);
  return changed;
}

}  // namespace beam
