// SPDX-License-Identifier: Apache-2.0
#include "ui/sample_folder.h"

#include <QStandardPaths>

namespace beam {
namespace fs = std::filesystem;

fs::path sampleFolder() {
  return fs::path(QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation).toStdString()) /
         "beam-studio" / "Sample";
}

void makeSampleOnce(const StudioServices& services, Progress& progress) {
  const fs::path folder = sampleFolder();
  if (fs::exists(folder)) return;
  const fs::path half = folder.parent_path() / "Sample.part";
  fs::remove_all(half);
  fs::create_directories(folder.parent_path());
  services.make_sample(half, progress);
  fs::rename(half, folder);
}

}  // namespace beam
