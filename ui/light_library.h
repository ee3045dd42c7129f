// SPDX-License-Identifier: Apache-2.0
// The panoramas one can light with: the capture's dome first, then those the user opened. Read and prepared
// for shading on a background thread, kept once read.
#pragma once

#include <QObject>

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "core/render/scene_renderer.h"
#include "viewers/latest_worker.h"

namespace beam {

struct LightEntry {
  QString name;
  std::filesystem::path file;
};

class LightLibrary final : public QObject {
  Q_OBJECT

 public:
  // A light that is chosen is prepared by a renderer of these, where they need no context; empty: it is read
  // alone.
  explicit LightLibrary(SceneRendererFactory new_renderer = {}, QObject* parent = nullptr);
  ~LightLibrary() override;

  // Starts anew with the dome of a capture, if it has one; chooses it.
  void reset(const std::filesystem::path& dome);
  // Adds the file (once) and chooses it; one that cannot be read leaves the light that was.
  void add(const std::filesystem::path& file);
  void choose(int index);

  const std::vector<LightEntry>& entries() const { return entries_; }
  int chosen() const { return chosen_; }             // -1: none
  std::shared_ptr<const Environment> light() const;  // of the chosen one; null while it is prepared
  QString name() const;
  // The chosen one is on its way.
  bool reading() const { return chosen_ >= 0 && seen_ != ticket_; }
  bool settled() const { return seen_ == ticket_; }

 Q_SIGNALS:
  void entriesChanged();
  void lightChanged();  // light(), name() or reading()
  void failed(const QString& what, const QString& why);

 private:
  int indexOf(const std::filesystem::path& file) const;  // -1: not there

  std::vector<LightEntry> entries_;
  SceneRendererFactory new_renderer_;
  std::map<std::filesystem::path, std::shared_ptr<const Environment>> prepared_;
  int chosen_ = -1;
  std::filesystem::path usable_;  // the chosen one that was there last; empty: none
  std::uint64_t ticket_ = 0, seen_ = 0;
  LatestWorker worker_;  // last: it stops first
};

}  // namespace beam
