//! One variant for each sentence about a record, with its values in SI.

use serde::{Deserialize, Serialize};

use super::parts::{MeasuredQuantity, MistakenUnits};
use crate::record::flag_code::FlagCode;
use crate::record::role::Role;
use labfiles::units::Dimension;

problems! {
    /// The file or its dataset cannot be read.
    Unreadable: FaultInFile {
        /// What the reader found, in English.
        found: String,
        /// What it advises.
        remedy: String,
    };
    /// A channel cannot be read.
    Unreadable: FaultInChannel {
        /// The channel.
        channel: String,
        /// What the reader found, in English.
        found: String,
        /// What it advises.
        remedy: String,
    };
    /// The file has fewer datasets than when it was listed.
    Unreadable: FewerDatasets {
        /// The file.
        path: String,
        /// How many it has.
        datasets: usize,
        /// Index of the one that is asked for.
        index: usize,
    };
    /// A file without a dataset.
    Empty: NoDataset {
        /// The file.
        path: String,
    };
    /// No channel that campaign.toml names can be used.
    Empty: NoUsableChannel;
    /// There are no samples.
    #[default]
    Empty: NoSamples;
    /// The whole record is skipped.
    Empty: AllSkipped {
        /// Length of the record, s.
        duration_s: f64,
        /// What is skipped, s.
        skip_s: f64,
    };
    /// A single sample.
    TooFewSamples: SingleSample;
    /// Too few samples to judge a channel.
    TooFewSamples: FewSamples {
        /// How many.
        samples: usize,
    };
    /// The dataset has no such channel.
    MissingChannel: NoSuchChannel {
        /// The channel as campaign.toml names it.
        channel: String,
        /// Its role.
        role: Role,
        /// Channels of the dataset.
        channels: Vec<String>,
    };
    /// The dataset has no such channel for its time axis.
    MissingChannel: NoSuchTimeAxis {
        /// The channel as campaign.toml names it.
        channel: String,
    };
    /// The file has no such dataset.
    MissingDataset: NoSuchDataset {
        /// The dataset as the run table names it.
        dataset: String,
        /// Line of the run table, from 1.
        line: usize,
        /// Datasets of the file, the first of them where there are many.
        datasets: Vec<String>,
    };
    /// File and campaign.toml state different units.
    WrongUnit: UnitContradicts {
        /// The channel.
        channel: String,
        /// Its role.
        role: Role,
        /// Unit in the file.
        stated: String,
        /// Unit in campaign.toml.
        ours: String,
    };
    /// File and campaign.toml state different units, that of campaign.toml without a symbol.
    WrongUnit: UnitContradictsOther {
        /// The channel.
        channel: String,
        /// Its role.
        role: Role,
        /// Unit in the file.
        stated: String,
    };
    /// A scale that starts from another unit than the channel's.
    WrongUnit: UnfitScale {
        /// The channel.
        channel: String,
        /// Its role.
        role: Role,
        /// What the channel's unit measures.
        dimension: Dimension,
    };
    /// The channel measures another quantity than its role.
    WrongUnit: WrongQuantity {
        /// The channel.
        channel: String,
        /// Its role.
        role: Role,
        /// What it measures.
        found: MeasuredQuantity,
        /// What it should.
        expected: MeasuredQuantity,
    };
    /// The channel of a motion is a voltage.
    WrongUnit: VoltageOfMotion {
        /// The channel.
        channel: String,
        /// Its role.
        role: Role,
        /// What it should measure.
        expected: MeasuredQuantity,
        /// SI unit of the role.
        unit: String,
    };
    /// The channel of a motion measures how far or fast something turns.
    WrongUnit: TurningMotion {
        /// The channel.
        channel: String,
        /// Its role.
        role: Role,
        /// What it measures.
        found: MeasuredQuantity,
        /// What it should.
        expected: MeasuredQuantity,
        /// A scale that makes a path of it.
        scale: String,
    };
    /// The file states a unit that is not known.
    UnitMissing: UnknownUnit {
        /// The channel.
        channel: String,
        /// Its role.
        role: Role,
        /// Unit in the file.
        unit: String,
    };
    /// Neither the file nor the campaign states a unit.
    UnitMissing: NoUnit {
        /// The channel.
        channel: String,
        /// Its role.
        role: Role,
    };
    /// The channel holds no real numbers.
    NotNumbers: NoRealNumbers {
        /// The channel.
        channel: String,
    };
    /// Some values are NaN or infinite.
    NotANumber: MissingValues {
        /// The channel.
        channel: String,
        /// How many.
        count: usize,
        /// The sample of the first.
        first: usize,
    };
    /// Some values are NaN or infinite: what lies between them is used.
    NotANumber: GapsLeftOut {
        /// The channel.
        channel: String,
        /// How many samples.
        count: usize,
        /// In how many gaps.
        gaps: usize,
        /// The sample of the first.
        first: usize,
    };
    /// Some values are NaN or infinite, a few in a row at most: they are filled.
    NotANumber: ShortGapsFilled {
        /// The channel.
        channel: String,
        /// How many samples.
        count: usize,
        /// In how many gaps.
        gaps: usize,
        /// The sample of the first.
        first: usize,
    };
    /// At no sample have all channels a value.
    NotANumber: NoCompleteSample;
    /// The channels differ in length.
    UnequalLengths: LengthsDiffer {
        /// Samples of the shortest.
        shortest: usize,
        /// Samples of the longest.
        longest: usize,
    };
    /// Samples without a value at the ends.
    Trimmed: EndsCutOff {
        /// How many.
        count: usize,
    };
    /// A channel is constant.
    DeadChannel: ConstantChannel {
        /// The channel.
        channel: String,
        /// Its value, SI.
        level: f64,
        /// What it measures.
        dimension: Dimension,
    };
    /// A channel reaches the limits of its converter.
    Clipped: ClippedSamples {
        /// The channel.
        channel: String,
        /// Samples there.
        count: usize,
        /// Their share of all.
        share: f64,
        /// Lower limit, SI.
        low: f64,
        /// Upper limit, SI.
        high: f64,
        /// What it measures.
        dimension: Dimension,
    };
    /// It does so in a free decay.
    Clipped: ClippedSwings {
        /// The channel.
        channel: String,
        /// Samples there.
        count: usize,
        /// Lower limit, SI.
        low: f64,
        /// Upper limit, SI.
        high: f64,
        /// What it measures.
        dimension: Dimension,
    };
    /// An acceleration reaches them at impacts.
    Clipped: ClippedSpikes {
        /// The channel.
        channel: String,
        /// Impacts at which it does.
        count: usize,
        /// The limit, SI.
        level: f64,
        /// What it measures.
        dimension: Dimension,
    };
    /// The rows are changes of a line.
    ContactChanges: ChangesOfLine {
        /// The channel with the states.
        channel: String,
        /// Rows that are impacts.
        count: usize,
        /// State of the closed contact.
        closed: f64,
    };
    /// The rows come in groups.
    ContactChanges: GroupsOfRows {
        /// Length of a group, s.
        closed_s: f64,
        /// Rows that are impacts.
        impacts: usize,
    };
    /// Each row is a throw.
    ContactChanges: ThrowsInRows {
        /// Throws that have enough impacts.
        throws: usize,
        /// Their impacts.
        impacts: usize,
    };
    /// Either of two lines may be the contact.
    ContactUnclear: EitherLine {
        /// A line.
        first: String,
        /// Another.
        second: String,
    };
    /// Which heights are drops, and which follow.
    Heights: HeightsTaken {
        /// Impacts between heights.
        impacts: usize,
        /// Drops.
        drops: usize,
        /// The greatest, m.
        highest_m: f64,
        /// The least, m.
        lowest_m: f64,
    };
    /// Heights rise about as often as they fall.
    ContactUnclear: HeightsRise {
        /// How many are not below the one before.
        rise: usize,
        /// How many have one before.
        all: usize,
    };
    /// A rebound ends above its drop.
    ContactUnclear: ReboundAboveDrop {
        /// The row, from 1.
        row: usize,
        /// Height of the drop, m.
        from_m: f64,
        /// Height after it, m.
        to_m: f64,
    };
    /// A height is negative.
    ContactUnclear: HeightBelowPlate {
        /// The row, from 1.
        row: usize,
    };
    /// No height has one after it.
    NoImpact: NoReboundHeight;
    /// Intervals between rows that grow.
    ContactUnclear: GrowingIntervals {
        /// All intervals.
        intervals: usize,
        /// Those longer than the one before.
        longer: usize,
        /// The row that ends the first of these.
        row: usize,
    };
    /// A camera's picture was frozen.
    FrozenFrames: FrozenPictures {
        /// The channel.
        channel: String,
        /// How often.
        count: usize,
        /// Samples of the first.
        samples: usize,
        /// First sample of the first.
        first: usize,
        /// Those that are interpolated.
        interpolated: usize,
    };
    /// A sensor gives fewer values than the record has samples.
    FrozenFrames: SlowerSensor {
        /// The channel.
        channel: String,
        /// Samples of each value.
        samples: f64,
    };
    /// A channel holds its value in the midst of a decay.
    FrozenFrames: HeldLeftOut {
        /// The channel.
        channel: String,
        /// How often.
        count: usize,
        /// Samples of all stretches.
        samples: usize,
        /// First sample of the first.
        first: usize,
    };
    /// Readings that begin again at the other end of their range were made to go on.
    Wrapped: ReadingsGoOn {
        /// The channel.
        channel: String,
        /// The range, in the file's unit.
        range: f64,
        /// How often.
        count: usize,
        /// After which sample first.
        first: usize,
    };
    /// Echoes of the impacts are heard.
    Echoes: EchoesLeftOut {
        /// How many.
        count: usize,
        /// Impacts without them.
        impacts: usize,
        /// How long the first of them takes, ms.
        delay_ms: f64,
    };
    /// Lone samples are far off those around them, and replaced.
    Spikes: LoneSpikes {
        /// The channel.
        channel: String,
        /// How many.
        count: usize,
        /// The first of them.
        first: usize,
    };
    /// All channels hold their value.
    DroppedSamples: HeldSamples {
        /// For how many samples.
        samples: usize,
        /// From which sample on.
        first: usize,
    };
    /// Samples are missing in the time axis.
    DroppedSamples: LostSamples {
        /// How many, a whole number.
        count: f64,
        /// After which time the first is missing, s.
        after_s: f64,
    };
    /// Time stamps are repeated.
    RepeatedSamples: RepeatedStamps {
        /// How many.
        count: usize,
    };
    /// The time axis holds no numbers.
    TimeUnreadable: NoTimes;
    /// The time runs backward.
    TimeBackward: TimeFalls {
        /// The last sample before.
        sample: usize,
        /// Its time, s.
        before_s: f64,
        /// The next time, s.
        after_s: f64,
    };
    /// The counter of the time begins again.
    TimeBackward: TimeTurns {
        /// The last sample before.
        sample: usize,
        /// Binary digits of the counter.
        bits: usize,
        /// What it counts.
        unit: String,
    };
    /// All times fall: the record is read from its end.
    TimeBackward: TimeTurnedAround {
        /// The time axis.
        axis: String,
    };
    /// An impact is not later than the one before.
    TimeBackward: ImpactsNotInOrder {
        /// Which impact, counted from 1.
        impact: usize,
    };
    /// Samples share stamps, and are not even between them.
    TimeNotUniform: UnevenStamps {
        /// Unit of the stamps, s.
        unit_s: f64,
    };
    /// The steps scatter.
    TimeNotUniform: ScatteredSteps {
        /// By how much, s.
        spread_s: f64,
        /// Their mean, s.
        mean_s: f64,
    };
    /// The steps scatter, or samples are missing, in a slow motion: its values at even times are interpolated.
    TimeNotUniform: PutOnEvenTimes {
        /// How many samples are missing.
        lost: usize,
        /// Standard deviation of the steps, s.
        spread_s: f64,
        /// The step, s.
        step_s: f64,
    };
    /// The times stray from equal steps.
    TimeNotUniform: StrayingTimes {
        /// By how much, s.
        stray_s: f64,
        /// The step, s.
        step_s: f64,
    };
    /// The rows are changes of the contact, not samples.
    TimeNotUniform: RowsAreChanges {
        /// The contact's channel.
        channel: String,
        /// The time axis.
        axis: String,
    };
    /// The time is printed too coarsely.
    TimeCoarse: FewStamps {
        /// Samples.
        samples: usize,
        /// Stamps that they share.
        stamps: usize,
    };
    /// The time axis has another unit than campaign.toml states.
    TimeUnitWrong: TimeUnitContradicts {
        /// The time axis.
        axis: String,
        /// Its unit, s.
        own_s: f64,
        /// What campaign.toml states, s.
        stated_s: f64,
    };
    /// The unit of the time axis may be any.
    TimeUnitMissing: TimeWithoutUnit {
        /// The time axis.
        axis: String,
        /// Its first number.
        first: f64,
        /// The usual step.
        step: f64,
    };
    /// What the time axis states is no unit of time.
    TimeUnitMissing: TimeInOtherUnit {
        /// The time axis.
        axis: String,
        /// Its unit.
        unit: String,
    };
    /// The time is taken as counted from 1970.
    TimeUnitAssumed: TimeTakenSince1970 {
        /// The time axis.
        axis: String,
        /// The unit.
        unit: String,
    };
    /// The time is taken as s.
    TimeUnitAssumed: TimeTakenAsSeconds {
        /// The time axis.
        axis: String,
    };
    /// The time is taken as days.
    TimeUnitAssumed: TimeTakenAsDays {
        /// The time axis.
        axis: String,
    };
    /// A channel begins later than the first.
    ChannelsShifted: LaterChannel {
        /// The channel.
        channel: String,
        /// By how much, s.
        by_s: f64,
    };
    /// A channel does not state when it begins.
    StartMissing: StartNotStated {
        /// The channel.
        channel: String,
    };
    /// A channel begins when others have ended.
    ChannelsApart: TooLateChannel {
        /// The channel.
        channel: String,
        /// By how much it is later than the first, s.
        by_s: f64,
    };
    /// Nothing states when samples were taken.
    NoSampleRate: NoClock;
    /// A rate stands beside a decimation.
    RateContradicts: RateBesideDecimation {
        /// The rate, Hz.
        rate_hz: f64,
        /// How many samples each stored one stands for.
        decimation: f64,
    };
    /// The header states another step than the time axis has.
    RateContradicts: StepContradicts {
        /// In the header, s.
        stated_s: f64,
        /// Of the time axis, s.
        measured_s: f64,
    };
    /// Two channels differ in sample rate.
    UnequalSampleRates: RatesOfTwoDiffer {
        /// A channel.
        channel: String,
        /// Its rate, Hz.
        rate_hz: f64,
        /// Another.
        other: String,
        /// Its rate, Hz.
        other_hz: f64,
    };
    /// A channel differs in sample rate from the others.
    UnequalSampleRates: RateUnlikeOthers {
        /// The channel.
        channel: String,
        /// Its rate, Hz.
        rate_hz: f64,
        /// That of the others, Hz.
        others_hz: f64,
    };
    /// A displacement follows the other mass.
    SwappedMasses: FollowsOtherMass {
        /// Correlation with the velocity of the other mass.
        crossed: f64,
        /// Correlation with that of its own.
        own: f64,
    };
    /// At contacts two velocities jump in opposite directions.
    OppositeSign: OppositeJumps;
    /// A quantity falls as the integral of its rate rises.
    OppositeSign: OppositeChannels {
        /// The quantity.
        quantity: Role,
        /// Its rate.
        rate: Role,
    };
    /// The same, and their scales differ.
    OppositeSign: OppositeUnlikeChannels {
        /// The quantity.
        quantity: Role,
        /// Its rate.
        rate: Role,
        /// The factor between their scales.
        factor: f64,
    };
    /// Both masses are measured along one axis.
    OppositeSign: SpeedsAlongOneAxis;
    /// One of two masses changes its velocity and the other flies on.
    SeparateBodies: MassesDoNotMeet {
        /// How often.
        alone: usize,
        /// How often both change theirs.
        together: usize,
    };
    /// A displacement moves farther or less than its velocity states.
    ScalesContradict: PathsDiffer {
        /// The displacement.
        quantity: Role,
        /// The velocity.
        rate: Role,
        /// Ratio of the two.
        ratio: f64,
    };
    /// The same, by a factor between two units.
    ScalesContradict: PathsDifferByUnits {
        /// The displacement.
        quantity: Role,
        /// The velocity.
        rate: Role,
        /// Ratio of the two.
        ratio: f64,
        /// The units.
        units: MistakenUnits,
    };
    /// A velocity changes more or less than its acceleration states.
    ScalesContradict: SpeedsDiffer {
        /// The velocity.
        quantity: Role,
        /// The acceleration.
        rate: Role,
        /// Ratio of the two.
        ratio: f64,
    };
    /// The same, by a factor between two units.
    ScalesContradict: SpeedsDifferByUnits {
        /// The velocity.
        quantity: Role,
        /// The acceleration.
        rate: Role,
        /// Ratio of the two.
        ratio: f64,
        /// The units.
        units: MistakenUnits,
    };
    /// The drive channel holds no harmonic tone.
    DriveNotHarmonic: NoTone;
    /// Measured and stated drive frequency differ.
    DriveFrequencyContradicts: FrequencyUnlikeStated {
        /// Measured, Hz.
        measured_hz: f64,
        /// Stated, Hz.
        stated_hz: f64,
    };
    /// The same, by a factor between two units.
    DriveFrequencyContradicts: FrequencyInOtherUnits {
        /// Measured, Hz.
        measured_hz: f64,
        /// Stated, Hz.
        stated_hz: f64,
        /// The units.
        units: MistakenUnits,
    };
    /// Some records alone have another drive frequency than their rows of the run table state, so that their other settings may be
    /// others too.
    RowContradicts: RowOfAnother {
        /// Measured, Hz.
        measured_hz: f64,
        /// Stated, Hz.
        stated_hz: f64,
    };
    /// Measured and stated drive amplitude differ.
    DriveAmplitudeContradicts: AmplitudeUnlikeStated {
        /// Measured, over that of the records of the nominal drive.
        measured: f64,
        /// Stated, over the nominal one.
        stated: f64,
    };
    /// A displacement goes beyond the stop without an impact.
    BeyondStop: PathBeyondStop {
        /// How far it goes, m.
        reached_m: f64,
        /// Stated clearance, m.
        clearance_m: f64,
    };
    /// A displacement goes beyond the other mass without an impact.
    BeyondStop: PathBeyondMass {
        /// How far it goes, m.
        reached_m: f64,
        /// Stated clearance, m.
        clearance_m: f64,
    };
    /// Jumps of the approach velocity go up.
    JumpsPointTheWrongWay: UpwardJumps {
        /// How many go up.
        up: usize,
        /// How many go down.
        down: usize,
    };
    /// The velocity is positive away from the stop.
    MeasuredAway: AwayFromStop;
    /// The velocities are positive away from the other mass.
    MeasuredAway: AwayFromMass;
    /// Two masses fly freely and one alone is measured.
    OneMassAlone: OtherMassNotMeasured;
    /// Part of the approach to an impact is no free flight.
    ApproachCut: ApproachInPart {
        /// Time of the impact, s.
        time_s: f64,
        /// What is left out before it, s.
        cut_s: f64,
    };
    /// Falls of the velocity without a free flight before the first of them.
    NoFreeFlight: NoFlightBefore {
        /// How many.
        count: usize,
        /// Time of the first, s.
        time_s: f64,
    };
    /// Falls of the velocity without a free flight after the first of them.
    NoFreeFlight: NoFlightAfter {
        /// How many.
        count: usize,
        /// Time of the first, s.
        time_s: f64,
    };
    /// Approach speeds above any that was measured.
    SpeedNeverMeasured: SpeedBeyondMeasured {
        /// Impacts with such speeds.
        count: usize,
        /// Time of the first, s.
        time_s: f64,
    };
    /// No impact between two free flights.
    NoImpact: NoImpactBetweenFlights;
    /// Too few times of impacts.
    NoImpact: FewTimes {
        /// How many.
        impacts: usize,
        /// How many are needed.
        needed: usize,
    };
    /// Too few impacts heard.
    NoImpact: FewSounds {
        /// How many.
        impacts: usize,
        /// How many are needed.
        needed: usize,
    };
    /// No free decay was found.
    NoFreeDecay: NoDecayFound;
    /// The motion does not swing.
    NoFreeDecay: ComesToRest;
    /// The numbers are those of successive swings.
    NoFreeDecay: SwingsListed {
        /// How many.
        count: usize,
    };
    /// The oscillation grows.
    NoFreeDecay: MotionGrows {
        /// Its size in the last third of the record over that in the first.
        times: f64,
    };
    /// Contact pulses without a jump of velocity, of a record that is identified.
    ContactWithoutVelocityJump: PulsesWithoutJump {
        /// Pulses without one.
        pulses: usize,
        /// Impacts with one.
        impacts: usize,
    };
    /// Contacts without a jump of velocity, of a record that is checked.
    ContactWithoutJump: ContactsWithoutJump {
        /// Contacts without one.
        without: usize,
        /// Contacts with one.
        with: usize,
    };
    /// The contact's threshold is within its noise.
    ThresholdInNoise: ThresholdWithinNoise {
        /// The threshold, SI.
        threshold: f64,
        /// The level at rest, SI.
        rest: f64,
        /// Standard deviation of the noise, SI.
        noise: f64,
        /// Of the channel.
        dimension: Dimension,
    };
    /// The contact opens at impacts.
    ContactInverted: ContactOpens {
        /// Share of the record in which it is beyond its threshold.
        share: f64,
    };
    /// The campaign excludes the record.
    Excluded: ExcludedByCampaign;
}
