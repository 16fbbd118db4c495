// What a message says, for programs: its sentence may be written better, its id stays. JSON and Python have the ids as words joined by
// hyphens, "file-missing".
#pragma once

#include <string>

// One row per id. The first three groups are kinds of errors, which a program can answer; the parts of the message say what of.
#define GLIM_MESSAGE_IDS(ID)                                              \
    /* Files */                                                           \
    ID(FileMissing)                                                       \
    ID(FileUnreadable)                                                    \
    ID(FileUnwritable)                                                    \
    ID(FileInUse)     /* by another glim */                               \
    ID(FileDamaged)   /* ends early, or holds what cannot be */           \
    ID(UnknownFormat) /* another kind of file, or another version */      \
    ID(OutsideFolder) /* a file names one that is not below its folder */ \
    /* What is asked for, or held by a file */                            \
    ID(Missing)     /* what must be given or be there is not */           \
    ID(UnknownName) /* of an option, a member, a camera, a device */      \
    ID(AmbiguousName)                                                     \
    ID(Malformed) /* a text that does not parse */                        \
    ID(WrongType)                                                         \
    ID(OutOfRange)                                                        \
    ID(DanglingIndex) /* into a list that ends before it */               \
    ID(Duplicate)                                                         \
    ID(Conflict)   /* two things that do not go together */               \
    ID(Requires)   /* one thing without another */                        \
    ID(Mismatch)   /* counts, sizes or origins of two things differ */    \
    ID(Degenerate) /* no direction, no volume, no inverse */              \
    ID(Cycle)                                                             \
    ID(Unsupported) /* right, but not drawn by glim */                    \
    ID(Empty)       /* nothing to draw or to compare */                   \
    /* Limits, devices and libraries */                                   \
    ID(TooLarge) /* for glim or for a format of files */                  \
    ID(OutOfMemory)                                                       \
    ID(DeviceMissing)                                                     \
    ID(DeviceLimit)                                                       \
    ID(DeviceLacks) /* a feature that glim needs */                       \
    ID(DriverFailed)                                                      \
    ID(LibraryMissing)                                                    \
    ID(LibraryFailed)                                                     \
    ID(ProgramMissing)                                                    \
    ID(ProgramFailed)                                                     \
    ID(NoWindow)                                                          \
    ID(Stopped) /* by its user */                                         \
    ID(PicturesDiffer)                                                    \
    /* Warnings: the picture may be other than its user expects */        \
    ID(NoLight)                                                           \
    ID(ExtensionIgnored)                                                  \
    ID(RestPose)                                                          \
    ID(StaysSharp) /* moves while the shutter is open */                  \
    ID(RepairedTexels)                                                    \
    ID(ExtrasIgnored)                                                     \
    ID(StudioLight)                                                       \
    ID(OwnLight)                                                          \
    ID(FramedCamera)                                                      \
    ID(WeightsClamped)                                                    \
    ID(WeightsNormalized)                                                 \
    ID(MissingMorphTarget)                                                \
    ID(MorphAttributeIgnored)                                             \
    ID(ConeClamped)                                                       \
    ID(MirroredCamera)                                                    \
    ID(ExtremeAspectRatio)                                                \
    ID(NoScene)                                                           \
    ID(ParentTransformIgnored)                                            \
    ID(InvisibleNode)                                                     \
    ID(AnimationIgnored)                                                  \
    ID(MatrixDecomposed)                                                  \
    ID(UnorderedKeys)                                                     \
    ID(AnimatedValueClamped)                                              \
    ID(ZeroIgnored)                                                       \
    ID(NumberClamped)                                                     \
    ID(NullIgnored)                                                       \
    ID(MatrixRounded)                                                     \
    ID(LaterVersion) /* of glTF */                                        \
    ID(MeshWithoutPosition)                                               \
    ID(EmptyMesh)                                                         \
    ID(NoTextureCoordinates)                                              \
    ID(FlatTextureCoordinates)                                            \
    ID(FlattenedNode)                                                     \
    ID(TinyScene)                                                         \
    ID(FarPart)                                                           \
    ID(EmptySphere)                                                       \
    ID(UnterminatedJpeg)                                                  \
    ID(GreyImage)                                                         \
    ID(UnknownSampler)                                                    \
    ID(SplatsAsPoints)                                                    \
    ID(TextureWithoutSource)                                              \
    ID(TooManyUvSets)                                                     \
    ID(VolumeTextureIgnored)                                              \
    ID(FlatTriangle)                                                      \
    ID(BadNormal)                                                         \
    ID(HiddenLight)                                                       \
    ID(LiftedLight)                                                       \
    ID(ExposureAdvised)                                                   \
    ID(PixelsWithoutSamples)                                              \
    ID(NonFiniteSamples)                                                  \
    ID(NonFinitePixels)                                                   \
    ID(TransparencyCap)                                                   \
    ID(MediaCap)                                                          \
    ID(ScatteringCap)                                                     \
    ID(UnreachedVolume) /* by point, spot and directional lights */       \
    ID(LightClamped)                                                      \
    ID(TargetUnreachable)                                                 \
    ID(PartsIgnored)                                                      \
    ID(MoreWarnings)                                                      \
    /* Notes */                                                           \
    ID(TextureMemory)                                                     \
    ID(GroupMemory)                                                       \
    ID(CameraChosen)                                                      \
    ID(ToneChosen)                                                        \
    ID(ExposureChosen)                                                    \
    ID(FocusFound)                                                        \
    ID(AlphaLost)                                                         \
    ID(HalfOverflow)                                                      \
    ID(BegunAnew)                                                         \
    ID(Resumed)                                                           \
    ID(OtherRounding)                                                     \
    ID(NoCheckpoint)                                                      \
    ID(StoppedBySignal)                                                   \
    ID(NotInformed)                                                       \
    ID(NotDenoised)                                                       \
    ID(CommandRuns)                                                       \
    ID(CommandFailed)                                                     \
    ID(NotLocked)                                                         \
    ID(IncompleteFilm)                                                    \
    ID(WindowReport)

namespace glim {

#define GLIM_ENUMERATE(name) name,
enum class MessageId : unsigned char { GLIM_MESSAGE_IDS(GLIM_ENUMERATE) };
#undef GLIM_ENUMERATE

#define GLIM_COUNT(name) +1
constexpr unsigned kMessageIdCount = 0 GLIM_MESSAGE_IDS(GLIM_COUNT);
#undef GLIM_COUNT

// "file-missing"
std::string toText(MessageId id);

}  // namespace glim
