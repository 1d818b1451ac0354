//! What a report states of its own: axes, keys, headings, captions, heads of tables. Each phrase is a
//! variant, and its texts are in the files of the languages.

use strum::VariantArray;

use impact_records::language::Language;
use impact_records::motion::{BoundaryKind, Motion};
use impact_records::record::Role;

/// A phrase of the report. Its name in small letters is the key of its text in `[text.phrase]` of each language's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "snake_case")]
#[expect(missing_docs, reason = "each is its text")]
pub enum Phrase {
    // Campaigns compared
    AgainstTheFirst,
    CampaignsCompared,
    CaptionTrend,
    DifferenceOf,
    DifferencesFromTheFirst,
    EachAlone,
    ErrorsInCommon,
    ErrorsOfTheRig,
    HowDifferencesAreFound,
    IfNothingWereShared,
    RelativeDifference,
    SharedBy,
    TableCampaigns,
    TableDifferences,
    TableNotShared,
    TableShared,
    NoChange,
    TestOfNoChange,
    Trend,
    // Uncertainty
    BeyondTheModel,
    UncertaintyBudget,
    ExpandedMeans,
    UncertaintyAndEffects,
    StatedClearance,
    CombinedUncertainty,
    CoverageFactor,
    DegreesOfFreedom,
    ClockOfSampler,
    ChangeOverSpeed,
    InstrumentThatIsOff,
    DisagreementOfMethods,
    EffectiveDegreesOfFreedom,
    BeyondFirstOrder,
    SharedGains,
    ExpandedUncertainty,
    NoiseOf,
    ScatterBetweenGroups,
    UncertaintySource,
    EvaluationType,
    StandardUncertainty,
    FurtherSources,
    // The page while records arrive
    RecordsAreArriving,
    // Axes
    TimeInDrivePeriods,
    Amplitude,
    Autocorrelation,
    BracketLessSimulatedBoundary,
    Clearance,
    ClearanceRatio,
    ClosingSpeedBeforeImpact,
    Contact,
    Density,
    Drive,
    DriveFrequency,
    Frame,
    FrequencyRatio,
    LagInObservations,
    PartingSpeedAfter,
    PhaseBehindTheDrive,
    Residual,
    Restitution,
    RiseOfChiSquared,
    Signal,
    WeightedResidual,
    // Keys and notes of figures
    Band95,
    Interval95,
    RestitutionOverSpeed,
    BracketNotUsed,
    FitOfOneDegree,
    FitOfOneDegreeFails,
    GrazingSimulated,
    ImpactsUsed,
    Measured,
    MeasuredMotions,
    SimulatedRegions,
    MeasuredBracket,
    MeasuredWithStandardError,
    NotModelled,
    NotUsed,
    OtherEdgeSimulated,
    PaleNotUsed,
    PeriodDoublingSimulated,
    PhasePortraits,
    SaddleNodeSimulated,
    Simulated,
    RmsResidual,
    // What hovering over a point shows
    ConfidenceOf,
    ResidualOf,
    SweepDown,
    SweepUnknown,
    SweepUp,
    // Titles of figures
    CorrelationOfTheParameters,
    EstimatesOfAllMethods,
    FreeDecaysAndTheirFits,
    BracketsAgainstBoundary,
    MotionsAndBoundaries,
    PointComparedTitle,
    ProfileLikelihoods,
    RegionsSimulatedAndMeasured,
    ResidualDiagnostics,
    ResonanceCurve,
    SpeedsAfterOverBeforeImpact,
    // Motions, channels, parameters, methods
    Beat,
    Chaotic,
    Sticking,
    Undetermined,
    CoefficientOfRestitution,
    DampingRatio,
    NaturalFrequency,
    StaticDeflection,
    JointTitle,
    Joint,
    // First page
    AgreementUnknown,
    ClearancesInDoubt,
    NoClearanceStated,
    IdentifiedInPart,
    Identified,
    IdentifiedEachSpecimen,
    IdentifiedRig,
    NotIdentifiableTitle,
    SyntheticData,
    MethodsAgree,
    MethodsDisagree,
    DoesNotFit,
    RigDoesNotFit,
    FitsSomeSpecimens,
    Contents,
    ReportOf,
    NotComputed,
    ProposedSetting,
    WhatWasMeasured,
    NotDetermined,
    NotIdentifiable,
    WeaklyIdentified,
    Range,
    Campaign,
    Channels,
    Clearances,
    Laboratory,
    NominalValues,
    Records,
    Rig,
    Sampling,
    FromOneFile,
    FromFiles,
    ImpactsDetected,
    DampingRatioSymbol,
    HighPassAt,
    NaturalFrequencySymbol,
    StaticDeflectionSymbol,
    PublishedSpeeds,
    OneMass,
    TwoMasses,
    UncertaintyOfTheGains,
    ManyClearances,
    RecordLength,
    MeasuredFrequencies,
    ReadAndUsed,
    // Headings
    AllRecords,
    Appendix,
    Conventions,
    Figure,
    MethodByMethod,
    RegionsOfMotion,
    SettingsVersionsInputs,
    SimulatedAndMeasuredMotions,
    SpecimenBySpecimen,
    WhatWasLeftOut,
    // Captions of figures
    CaptionBoundaryFit,
    CaptionClearancesInDoubt,
    CaptionStrips,
    CaptionCorrelation,
    CaptionCorrelationOthers,
    CaptionComparisons,
    CaptionCells,
    CaptionDecays,
    CaptionOtherMotion,
    CaptionBoundariesAlone,
    CaptionBands,
    CaptionLetters,
    CaptionMap,
    CaptionData,
    CaptionMissedContacts,
    CaptionPoint,
    CaptionSetting,
    CaptionRecord,
    CaptionSimulatedMotion,
    CaptionProfiles,
    CaptionResonance,
    CaptionImpacts,
    CaptionRegions,
    CaptionAlikeInKind,
    CaptionResiduals,
    CaptionResidualsThinned,
    // Tables
    TablePublished,
    PublishedSpeed,
    TableAgreement,
    TableRecordsByMethod,
    TableRecords,
    TableMethods,
    EdgeMeans,
    FarBrackets,
    TableBrackets,
    TableManyBrackets,
    TableHashes,
    TableManyRecords,
    SomeRecords,
    AboveBy,
    AndMethod,
    BelowBy,
    Boundary,
    ConfidenceShort,
    Count,
    DifferenceOverError,
    Fits,
    Impacts,
    Input,
    LeftOut,
    MeasuredBetween,
    Method,
    MotionUndetermined,
    No,
    NotUsedBecause,
    ObservationsShort,
    PValue,
    Parameter,
    Record,
    Remark,
    Specimen,
    Sweep,
    UsedByAndFlags,
    Verdict,
    Why,
    Within,
    Yes,
    DetailsOfOne,
    // Conventions and settings
    MeaningOfMotion,
    IntervalsAndUnits,
    SettingsAsResolved,
    CommandAgain,
    Versions,
    MeaningOfClearanceRatio,
    MeaningOfRestitution,
    MeaningOfDampingRatio,
    MeaningOfFrequencyRatio,
    MeaningOfEquation,
    MeaningOfStaticDeflection,
    MeaningOfTime,
    // Buttons of the page
    SaveAsSVG,
    WholeFigure,
    ZoomIn,
    ZoomOut,
}

impl Phrase {
    /// All phrases.
    pub const ALL: &'static [Self] = <Self as VariantArray>::VARIANTS;

    /// The text in a language; symbols are between dollars, places of values in braces.
    pub fn text(self, language: Language) -> &'static str {
        language.text("phrase", self.into())
    }

    /// The English text, which is the phrase's key in a table of words.
    pub fn english(self) -> &'static str {
        self.text(Language::default())
    }
}

/// A text of a figure: a phrase, a phrase with a unit or a count behind it, or a text that is the same
/// in every language.
#[derive(Debug, Clone, PartialEq)]
pub enum Text {
    /// A phrase.
    Phrase(Phrase),
    /// A phrase and what follows it.
    Followed(Phrase, String),
    /// What a channel measures.
    Role(Role),
    /// The symbol of a boundary.
    Boundary(BoundaryKind),
    /// Symbols, names and the theory's figures, which are English.
    Plain(String),
}

impl From<Phrase> for Text {
    fn from(phrase: Phrase) -> Self {
        Self::Phrase(phrase)
    }
}

/// A phrase and its unit, which is printed in brackets.
impl From<(Phrase, &str)> for Text {
    fn from((phrase, unit): (Phrase, &str)) -> Self {
        Self::Followed(phrase, format!(" ({unit})"))
    }
}

impl From<Role> for Text {
    fn from(role: Role) -> Self {
        Self::Role(role)
    }
}

impl From<BoundaryKind> for Text {
    fn from(kind: BoundaryKind) -> Self {
        Self::Boundary(kind)
    }
}

impl From<&str> for Text {
    fn from(text: &str) -> Self {
        Self::Plain(text.to_owned())
    }
}

impl From<String> for Text {
    fn from(text: String) -> Self {
        Self::Plain(text)
    }
}

/// The label of a motion.
pub(crate) fn motion_text(motion: &Motion) -> Text {
    match motion {
        Motion::Impactless | Motion::Periodic { .. } => motion.label().into(),
        Motion::Beat => Phrase::Beat.into(),
        Motion::Chaotic => Phrase::Chaotic.into(),
        Motion::Sticking => Phrase::Sticking.into(),
        Motion::Undetermined { .. } => Phrase::Undetermined.into(),
    }
}
