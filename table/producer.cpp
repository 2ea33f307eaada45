#include "table/producer.h"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <vector>

#include "support/threads.h"

namespace clothbrdf {
namespace {

// Large enough that files are written in pieces the system likes, small enough for the processor's
// cache.
constexpr std::size_t kBlockValues = 32000;
// Blocks of slow cells take minutes: work is counted in smaller steps, and given up between them.
constexpr std::size_t kStepValues = 256;

struct Block {
  std::size_t first_row = 0;
  std::vector<double> values;
  Handover passed_on;
};

}  // namespace

void fill_all_pairs(const Producer& producer, Workers workers, std::span<const Directions> pairs,
                    std::span<double> values) {
  constexpr std::size_t kPairsOfBlock = 4096;
  const std::size_t channels = producer.spec().channels.size();
  const auto fill = [&](std::size_t block) {
    workers.check();
    const std::size_t first = block * kPairsOfBlock;
    const std::size_t count = std::min(kPairsOfBlock, pairs.size() - first);
    producer.fill_pairs(pairs.subspan(first, count),
                        values.subspan(first * channels, count * channels));
  };
  const std::size_t blocks = (pairs.size() + kPairsOfBlock - 1) / kPairsOfBlock;
  with_threads(workers.threads, [&] { run_parallel(blocks, workers, fill); });
}

void stream_rows(const Producer& producer, Workers workers, const RowFunction& take,
                 const RowFunction& prepare) {
  const TableSpec& spec = producer.spec();
  const std::size_t rows = spec.row_count();
  const auto threads = static_cast<std::size_t>(workers.threads);
  // Small tables can be the slowest ones: enough blocks for all threads, too.
  constexpr std::size_t kBlocksPerThread = 8;
  const std::size_t rows_per_block = std::max<std::size_t>(
      1, std::min(kBlockValues / spec.row_values(), rows / (kBlocksPerThread * threads)));
  const std::size_t rows_per_step = std::max<std::size_t>(1, kStepValues / spec.row_values());

  // A ring of buffers: at most so many blocks are under way, and they are taken in order.
  const std::size_t tokens = 2 * threads + 1;
  std::vector<Block> ring(tokens);
  std::size_t next_row = 0;
  std::size_t next_slot = 0;
  static ParallelWork parallel;
  static Handover counters;
  const auto next = [&](tbb::flow_control& control) -> Block* {
    const ParallelWork::Piece piece(parallel);
    counters.take();
    if (next_row >= rows) {
      control.stop();
      return nullptr;
    }
    Block& block = ring[next_slot];
    next_slot = (next_slot + 1) % tokens;
    block.passed_on.take();
    block.first_row = next_row;
    block.values.resize(std::min(rows_per_block, rows - next_row) * spec.row_values());
    next_row += rows_per_block;
    block.passed_on.give();
    counters.give();
    return &block;
  };
  const auto compute = [&](Block* block) {
    const ParallelWork::Piece piece(parallel);
    block->passed_on.take();
    std::size_t row = block->first_row;
    for (std::span<double> left = block->values; !left.empty();) {
      const std::size_t count = std::min(rows_per_step, left.size() / spec.row_values());
      producer.fill_rows(row, left.first(count * spec.row_values()));
      workers.advance(count * spec.column_count());
      row += count;
      left = left.subspan(count * spec.row_values());
    }
    if (prepare) prepare(block->first_row, block->values);
    block->passed_on.give();
    return block;
  };
  static Handover taken;
  const auto hand_over = [&](Block* block) {
    const ParallelWork::Piece piece(parallel);
    taken.take();
    block->passed_on.take();
    take(block->first_row, block->values);
    block->passed_on.give();
    taken.give();
  };
  const ParallelWork::Caller caller(parallel);
  with_threads(workers.threads, [&] {
    tbb::parallel_pipeline(
        tokens, tbb::make_filter<void, Block*>(tbb::filter_mode::serial_in_order, next) &
                    tbb::make_filter<Block*, Block*>(tbb::filter_mode::parallel, compute) &
                    tbb::make_filter<Block*, void>(tbb::filter_mode::serial_in_order, hand_over));
  });
}

}  // namespace clothbrdf
