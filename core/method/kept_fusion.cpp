// SPDX-License-Identifier: Apache-2.0
#include "core/method/kept_fusion.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/method/zero_surface.h"

namespace beam {

KeptFusion::KeptFusion(Checkpoint& checkpoint, std::function<Digest()> of)
    : checkpoint_(checkpoint), of_(std::move(of)), reader_(checkpoint.kept()) {
  if (!reader_) return;
  const Digest own = std::exchange(of_, {})();
  try {
    head_ = reader_->list<Head>().at(0);
  } catch (const Error& damaged) {
    requireData(damaged);
  } catch (const std::out_of_range&) {
  }
  if (head_.of == own) return;
  reader_.reset();
  head_ = {.attempt = {}, .next = 0, .of = own};
}

void KeptFusion::begin(const FusionTry& attempt) {
  if (attempt.number != head_.attempt.number) reader_.reset();
  head_.attempt = attempt;
}

std::size_t KeptFusion::takeUp(std::size_t blocks, ZeroSurface& surface) {
  const std::unique_ptr<CheckpointReader> reader = std::move(reader_);
  if (!reader || head_.next > blocks) return 0;
  try {
    surface.takeUp(*reader);
  } catch (const Error& damaged) {
    requireData(damaged);
    logInfo("the mesh is begun anew: {}", damaged.what());
    return 0;
  }
  logInfo("the mesh goes on from what was kept: {} of {} blocks", head_.next, blocks);
  return head_.next;
}

void KeptFusion::keep(std::size_t next, const ZeroSurface& surface, const Progress& progress) {
  if (!checkpoint_.due()) return;
  if (of_) head_.of = std::exchange(of_, {})();
  head_.next = next;
  CheckpointWriter writer;
  writer.give(std::vector<Head>{head_});
  surface.keepIn(writer);
  checkpoint_.keep(writer, progress);
}

}  // namespace beam
