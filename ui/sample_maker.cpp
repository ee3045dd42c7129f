// SPDX-License-Identifier: Apache-2.0
#include "ui/sample_maker.h"

#include <QStandardPaths>

#include "core/base/error.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr int kTell_ms = 100;

}  // namespace

SampleMaker::SampleMaker(QObject* parent) : QObject(parent) {
  timer_.setInterval(kTell_ms);
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (const auto report = report_.latest()) Q_EMIT progressed(*report);
  });
}

SampleMaker::~SampleMaker() = default;

void SampleMaker::start(const StudioServices& services) {
  const fs::path base =
      fs::path(QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation).toStdString()) /
      "beam-studio";
  const fs::path folder = base / "Sample";
  if (fs::exists(folder)) {
    Q_EMIT done(QString::fromStdString(folder.string()));
    return;
  }
  busy_ = true;
  timer_.start();
  thread_ = std::jthread([this, base, folder, make = services.make_sample](const std::stop_token& stop) {
    QString error;
    bool complete = false;
    const fs::path half = base / "Sample.part";  // a killed attempt never passes for a sample
    try {
      fs::remove_all(half);
      fs::create_directories(base);
      Progress progress(
          stop, [this](const ProgressReport& r) { report_.publish(std::make_shared<ProgressReport>(r)); });
      make(half, progress);
      fs::rename(half, folder);
      complete = true;
    } catch (const Cancelled&) {
    } catch (const std::exception& e) {  // the border of this thread: said in the window
      error = QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this, [this, folder, error, complete] { finish(folder, error, complete); }, Qt::QueuedConnection);
  });
}

void SampleMaker::finish(const fs::path& folder, const QString& error, bool complete) {
  busy_ = false;
  timer_.stop();
  if (complete) {
    Q_EMIT done(QString::fromStdString(folder.string()));
  } else {
    Q_EMIT failed(error);
  }
}

}  // namespace beam
