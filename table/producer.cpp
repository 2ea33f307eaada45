#include "table/producer.h"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <vector>

#include "support/threads.h"

namespace clothbrdf {
namespace {

// Large enough that files are written in pieces the system likes, small enough for the processor's
// cache.
constexpr std::size_t kBlockValues = 98000;

struct Block {
  std::size_t first_row = 0;
  std::vector<double> values;
};

}  // namespace

void stream_rows(const Producer& producer, int threads, const RowFunction& take,
                 const RowFunction& prepare) {
  const TableSpec& spec = producer.spec();
  const std::size_t rows = spec.row_count();
  // Small tables can be the slowest ones: enough blocks for all threads, too.
  constexpr std::size_t kBlocksPerThread = 8;
  const std::size_t rows_per_block = std::max<std::size_t>(
      1, std::min(kBlockValues / spec.row_values(),
                  rows / (kBlocksPerThread * static_cast<std::size_t>(threads))));

  // A ring of buffers: at most so many blocks are under way, and they are taken in order.
  const std::size_t tokens = 2 * static_cast<std::size_t>(threads) + 1;
  std::vector<Block> ring(tokens);
  std::size_t next_row = 0;
  std::size_t next_slot = 0;
  const auto next = [&](tbb::flow_control& control) -> Block* {
    if (next_row >= rows) {
      control.stop();
      return nullptr;
    }
    Block& block = ring[next_slot];
    next_slot = (next_slot + 1) % tokens;
    block.first_row = next_row;
    block.values.resize(std::min(rows_per_block, rows - next_row) * spec.row_values());
    next_row += rows_per_block;
    return &block;
  };
  const auto compute = [&](Block* block) {
    producer.fill_rows(block->first_row, block->values);
    if (prepare) prepare(block->first_row, block->values);
    return block;
  };
  const auto hand_over = [&](Block* block) { take(block->first_row, block->values); };
  with_threads(threads, [&] {
    tbb::parallel_pipeline(
        tokens, tbb::make_filter<void, Block*>(tbb::filter_mode::serial_in_order, next) &
                    tbb::make_filter<Block*, Block*>(tbb::filter_mode::parallel, compute) &
                    tbb::make_filter<Block*, void>(tbb::filter_mode::serial_in_order, hand_over));
  });
}

}  // namespace clothbrdf
