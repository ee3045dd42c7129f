// SPDX-License-Identifier: Apache-2.0
#include "ui/light_library.h"

#include <algorithm>

#include "core/stages/panorama_file.h"

namespace beam {

namespace {

// So that the first picture in it does not wait for that.
void prepare(const std::shared_ptr<const Environment>& light, const SceneRendererFactory& new_renderer) {
  if (!new_renderer) return;
  const auto renderer = new_renderer();
  RenderScene scene;
  scene.environment = light;
  if (!renderer->abilities().needs_context) renderer->load(scene);
}

}  // namespace

LightLibrary::LightLibrary(SceneRendererFactory new_renderer, QObject* parent)
    : QObject(parent), new_renderer_(std::move(new_renderer)) {}

LightLibrary::~LightLibrary() = default;

void LightLibrary::reset(const std::filesystem::path& dome) {
  entries_.clear();
  prepared_.clear();
  chosen_ = -1;
  usable_.clear();
  if (!dome.empty()) entries_.push_back({"Dome of the capture", dome});
  Q_EMIT entriesChanged();
  choose(dome.empty() ? -1 : 0);
}

void LightLibrary::add(const std::filesystem::path& file) {
  if (indexOf(file) < 0) {
    entries_.push_back({QString::fromStdString(file.stem().string()), file});
    Q_EMIT entriesChanged();
  }
  choose(indexOf(file));
}

int LightLibrary::indexOf(const std::filesystem::path& file) const {
  const auto known =
      std::find_if(entries_.begin(), entries_.end(), [&](const LightEntry& e) { return e.file == file; });
  return known == entries_.end() ? -1 : static_cast<int>(known - entries_.begin());
}

void LightLibrary::choose(int index) {
  chosen_ = index;
  const std::uint64_t ticket = ++ticket_;
  if (index < 0 || prepared_.contains(entries_[index].file)) {
    seen_ = ticket;
    usable_ = index < 0 ? std::filesystem::path() : entries_[index].file;
    Q_EMIT lightChanged();
    return;
  }
  Q_EMIT lightChanged();
  worker_.submit([this, file = entries_[index].file, ticket, new_renderer = new_renderer_] {
    std::shared_ptr<const Environment> light;
    QString error;
    try {
      auto read = openPanorama(file);
      prepare(read, new_renderer);
      light = std::move(read);
    } catch (const std::exception& e) {  // the border of this thread: said in the window
      error = QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this,
        [this, file, light, error, ticket] {
          if (light) prepared_[file] = light;
          if (ticket != ticket_) return;
          seen_ = ticket;
          if (light) usable_ = file;
          if (!error.isEmpty()) {
            entries_.erase(entries_.begin() + chosen_);
            chosen_ = indexOf(usable_);
            Q_EMIT failed("This panorama cannot be used", error);
            Q_EMIT entriesChanged();
          }
          Q_EMIT lightChanged();
        },
        Qt::QueuedConnection);
  });
}

std::shared_ptr<const Environment> LightLibrary::light() const {
  if (chosen_ < 0) return nullptr;
  const auto found = prepared_.find(entries_[chosen_].file);
  return found == prepared_.end() ? nullptr : found->second;
}

QString LightLibrary::name() const { return chosen_ < 0 ? QString() : entries_[chosen_].name; }

}  // namespace beam
