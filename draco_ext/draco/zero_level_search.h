// Streams without refinement at a target: the mesh itself or a simplified one, fitted to it.
#ifndef LACERTA_DRACO_ZERO_LEVEL_SEARCH_H_
#define LACERTA_DRACO_ZERO_LEVEL_SEARCH_H_

#include <memory>
#include <optional>

#include "draco/rate_control.h"
#include "draco/zero_level_steps.h"
#include "lacerta/mesh.h"
#include "lacerta/surface_distance.h"
#include "remesh/simplify.h"

namespace lacerta {

class ZeroLevelSearch;

// The best zero-level stream found: fewest bytes at a PSNR, highest PSNR at a number of bytes, over numbers of triangles and steps
// of the lattice; where nothing meets the target, the nearest. mesh: any that passed cleaning. Fails as EncodeZeroLevel does.
StatusOr<ZeroLevelStream> CodeZeroLevel(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                        const SearchEffort& effort = SearchEffort());
// The same where the collapses of `mesh` are known.
StatusOr<ZeroLevelStream> CodeZeroLevel(const TriangleMesh& mesh, const SimplificationSequence& sequence, const SurfaceDistanceMeter& meter,
                                        const ResolvedTarget& target, const SearchEffort& effort);

// A search for a stream without levels beside one with levels. All referenced objects must outlive it.
class SimplerStream {
 public:
  // sequence: of `mesh`.
  SimplerStream(const TriangleMesh& mesh, const SimplificationSequence& sequence, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                const SearchEffort& effort = SearchEffort());
  ~SimplerStream();

  // Whether a stream meets the PSNR in fewer than so many bytes. Never at a rate.
  StatusOr<bool> TakesFewerThan(double bytes);
  // Whether that is likely, by what TakesFewerThan has seen so far.
  bool MayTakeFewerThan(double bytes) const;
  // Looks for the stream already, if it may beat one of about so many bytes: IsBetterThan is quick then.
  void PrepareBeside(double bytes);
  // Whether a stream clearly beats `coded`, which has levels to show for its bytes: it meets the target in 5 % fewer of them, or with a
  // PSNR 0.3 dB higher in as many, or comes nearer to it. That it does not is often seen early.
  StatusOr<bool> IsBetterThan(const MeasuredStream& coded);

  // The one for which the last answer was yes.
  const ZeroLevelStream& stream() const { return *stream_; }

 private:
  bool IsHopeless(double bytes);           // for a simplified mesh at the PSNR to take fewer than so many
  StatusOr<bool> Find(double most_bytes);  // false: hopeless
  // Sets stream_ where there is none and one may take fewer than so many bytes.
  Status Look(double most_bytes);

  const TriangleMesh& mesh_;
  const SimplificationSequence& sequence_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget target_;
  const SearchEffort effort_;
  std::unique_ptr<ZeroLevelSearch> search_;  // null until there is hope
  std::optional<ZeroLevelStream> stream_;
  double hopeless_bytes_ = 0;  // so many or fewer are known to be
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_ZERO_LEVEL_SEARCH_H_
