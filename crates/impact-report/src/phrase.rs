//! What a report states of its own: axes, keys, headings, captions, heads of tables. Each phrase is a
//! variant with its English and its German text, so that none lacks a translation.

use impact_records::motion::Motion;
use impact_records::record::Role;

/// Defines [`Phrase`]: the variant, its English, its German. Symbols are between dollars, places of
/// values in braces.
macro_rules! phrases {
    ($($phrase:ident => $english:literal, $german:literal;)*) => {
        /// A phrase of the report.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[expect(missing_docs, reason = "each is its text")]
        pub enum Phrase {
            $($phrase,)*
        }

        impl Phrase {
            /// All phrases.
            pub const ALL: &[Self] = &[$(Self::$phrase),*];

            /// The English text, which is the phrase's key in a table of words.
            pub const fn english(self) -> &'static str {
                match self {
                    $(Self::$phrase => $english,)*
                }
            }

            /// The German text.
            pub const fn german(self) -> &'static str {
                match self {
                    $(Self::$phrase => $german,)*
                }
            }
        }
    };
}

phrases! {
// Campaigns compared
AgainstTheFirst => "against campaign 1, errors in common cancelled (95 %)", "gegen Messreihe 1, gemeinsame Fehler heben sich auf (95 %)";
CampaignsCompared => "The campaigns", "Die Messreihen";
CaptionTrend => "The campaigns in the order given. Grey: each campaign's own estimate with its 95 % interval. Blue: the first campaign's estimate plus the difference from it, with the 95 % interval of the difference, in which the errors that both campaigns have in common cancel.", "Die Messreihen in der angegebenen Reihenfolge. Grau: der Schätzwert jeder Messreihe mit ihrem 95-%-Intervall. Blau: der Schätzwert der ersten Messreihe und der Unterschied zu ihr, mit dem 95-%-Intervall des Unterschieds, in dem sich die gemeinsamen Fehler beider aufheben.";
DifferenceOf => "difference", "Unterschied";
DifferencesFromTheFirst => "Differences from campaign 1", "Unterschiede zu Messreihe 1";
EachAlone => "each campaign alone (95 %)", "jede Messreihe allein (95 %)";
ErrorsInCommon => "What the campaigns have in common", "Was den Messreihen gemeinsam ist";
ErrorsOfTheRig => "errors shared by its campaigns", "gemeinsame Fehler seiner Messreihen";
HowDifferencesAreFound => "Each campaign's joint fit is a Gaussian of its parameters and of what is fitted beside them: gains, corners, delays, errors of clearances, asymmetries, effects. What the campaigns share is one unknown with one prior; what is not shared, is one of each campaign. The differences and their covariance are those of all campaigns together. Scatter between groups of records, disagreement of methods and what the first order of the effects does not hold are taken as independent.", "Die gemeinsame Anpassung jeder Messreihe ist eine Normalverteilung ihrer Parameter und dessen, was daneben angepasst wird: Verstärkungen, Eckfrequenzen, Verzögerungen, Fehler der Spiele, Unsymmetrien, Effekte. Was die Messreihen gemeinsam haben, ist eine Unbekannte mit einem Vorwissen; alles andere ist eine Unbekannte jeder Messreihe. Die Unterschiede und ihre Kovarianz sind die aller Messreihen zusammen. Streuung zwischen Gruppen von Aufzeichnungen, Unterschiede der Verfahren und was die erste Ordnung der Effekte nicht enthält, gelten als unabhängig.";
IfNothingWereShared => "if nothing were shared", "wenn nichts gemeinsam wäre";
RelativeDifference => "relative", "relativ";
SharedBy => "in campaigns", "in den Messreihen";
TableCampaigns => "The campaigns: joint estimates with half their 95 % interval.", "Die Messreihen: gemeinsame Schätzwerte mit ihrem halben 95-%-Intervall.";
TableDifferences => "Differences from campaign 1 with half their 95 % interval; beside it what it would be if the campaigns had no error in common; p-value of no change of this parameter alone, not corrected for the number of differences (the first page says what is left of it once corrected).", "Unterschiede zu Messreihe 1 mit ihrem halben 95-%-Intervall; daneben, wie groß es ohne gemeinsame Fehler wäre; p-Wert dafür, dass sich dieser Parameter allein nicht geändert hat, nicht um die Zahl der Unterschiede berichtigt (was berichtigt davon bleibt, sagt die erste Seite).";
TableNotShared => "Errors that two campaigns might share, and why they are treated as separate.", "Fehler, die zwei Messreihen gemeinsam haben könnten, und warum sie getrennt behandelt werden.";
TableShared => "What is one unknown of several campaigns, and why.", "Was eine Unbekannte mehrerer Messreihen ist, und warum.";
NoChange => "That nothing has changed: p {p}, corrected for the number of differences ({count}).", "Dass sich nichts geändert hat: p {p}, für die Zahl der Unterschiede ({count}) berichtigt.";
TestOfNoChange => "All {count} differences together: F = {statistic}, p {p}.", "Alle {count} Unterschiede zusammen: F = {statistic}, p {p}.";
Trend => "Estimates of the campaigns", "Schätzwerte der Messreihen";
// Uncertainty
ContactReach => "contact reach", "Kontaktweg";
RestitutionSpeed => "R over the speed", "R über der Geschwindigkeit";
ContactSpeed => "contact's length over the speed", "Kontaktdauer über der Geschwindigkeit";
BeyondTheModel => "Beyond the model the rig has, and the intervals allow for: {effects}. The section on the uncertainty states the size of each, and the remedy.", "Über das Modell hinaus hat die Maschine, und die Intervalle berücksichtigen es: {effects}. Der Abschnitt zur Unsicherheit nennt die Größe jedes Effekts und die Abhilfe.";
UncertaintyBudget => "Uncertainty budget: standard uncertainty of each source and what it contributes to that of the joint estimate, in units of 0.0001 (of $R$ absolute, of the others relative). Type A: by statistics; B: by other means.", "Unsicherheitsbudget: Standardunsicherheit jeder Quelle und ihr Beitrag zu der des gemeinsamen Schätzwerts, in Einheiten von 0,0001 (bei $R$ absolut, sonst relativ). Typ A: statistisch; B: auf andere Weise.";
UncertaintyAndEffects => "Uncertainty, and effects beyond the model", "Unsicherheit, und Effekte über das Modell hinaus";
ForceDependsOnFrequency => "a force that depends on frequency", "eine Kraft, die von der Frequenz abhängt";
StatedClearance => "clearance {clearance} mm as stated", "Spiel {clearance} mm wie angegeben";
CombinedUncertainty => "combined standard uncertainty", "kombinierte Standardunsicherheit";
ContactsOfFiniteDuration => "contacts of finite duration", "Kontakte endlicher Dauer";
CoverageFactor => "coverage factor for 95 %", "Erweiterungsfaktor für 95 %";
DegreesOfFreedom => "degrees of freedom", "Freiheitsgrade";
ClockOfSampler => "clock of the sampler", "Abtasttakt";
ChangeOverSpeed => "change of $R$ with the speed", "Änderung von $R$ mit der Geschwindigkeit";
InstrumentThatIsOff => "instrument that is off", "falsch zeigendes Messgerät";
DisagreementOfMethods => "disagreement of the methods", "Unterschied der Verfahren";
DriftOverTheCampaign => "drift over the campaign", "Drift über die Messreihe";
DryFriction => "dry friction", "trockene Reibung";
DragOfTheAir => "drag of the air", "Luftwiderstand";
SpringsStifferToOneSide => "springs that are stiffer to one side", "einseitig steifere Federn";
PickupFromTheDrive => "pickup from the drive", "Übersprechen der Erregung";
HystereticDampingOfTheSprings => "hysteretic damping", "Strukturdämpfung";
EffectiveDegreesOfFreedom => "effective degrees of freedom", "effektive Freiheitsgrade";
BeyondFirstOrder => "effects beyond the model, second order", "Effekte über das Modell hinaus, zweite Ordnung";
ExpandedUncertainty => "expanded uncertainty", "erweiterte Unsicherheit";
HarmonicsOfTheDrive => "harmonics of the drive", "Oberschwingungen der Erregung";
NoiseOf => "noise: {method}", "Rauschen: {method}";
ScatterBetweenGroups => "scatter between {count} groups of records", "Streuung zwischen {count} Gruppen von Aufzeichnungen";
UncertaintySource => "source", "Quelle";
NonlinearSprings => "springs that are not linear", "nichtlineare Federn";
EvaluationType => "type", "Typ";
StandardUncertainty => "uncertainty", "Unsicherheit";
FurtherSources => "{count} further sources", "{count} weitere Quellen";
// The page while records arrive
RecordsAreArriving => "Records are still arriving: this is the answer of {count} records so far. The page reloads itself when there is a newer one.", "Es kommen noch Aufzeichnungen hinzu: Dies ist die Antwort aus bisher {count} Aufzeichnungen. Die Seite lädt sich neu, sobald es eine neuere gibt.";
// Axes
TimeInDrivePeriods => "$t$/$T$ (drive periods)", "$t$/$T$ (Erregerperioden)";
Amplitude => "amplitude", "Amplitude";
Autocorrelation => "autocorrelation", "Autokorrelation";
BracketLessSimulatedBoundary => "bracket less simulated boundary", "Schranke minus simulierte Grenze";
Clearance => "clearance $r$", "Spiel $r$";
ClearanceRatio => "clearance ratio $ρ$ = $r$/$x_st$", "Spielverhältnis $ρ$ = $r$/$x_st$";
ClosingSpeedBeforeImpact => "approach speed before impact", "Annäherung vor dem Stoß";
Contact => "contact", "Kontakt";
Density => "density", "Dichte";
Drive => "drive", "Erregung";
DriveFrequency => "drive frequency $f$", "Erregerfrequenz $f$";
Frame => "frame", "Rahmen";
FrequencyRatio => "frequency ratio $η$ = $f$/$f_0$", "Frequenzverhältnis $η$ = $f$/$f_0$";
LagInObservations => "lag (observations)", "Versatz (Beobachtungen)";
PartingSpeedAfter => "separation speed after", "Trennung nach dem Stoß";
PhaseBehindTheDrive => "phase behind the drive", "Phase hinter der Erregung";
Residual => "residual", "Residuum";
Restitution => "restitution $R$", "Stoßzahl $R$";
RiseOfChiSquared => "rise of $χ$²", "Anstieg von $χ$²";
Signal => "signal", "Signal";
WeightedResidual => "weighted residual", "gewichtetes Residuum";
// Keys and notes of figures
Band95 => "95 % band", "95-%-Band";
Interval95 => "95 % interval", "95-%-Intervall";
RestitutionOverSpeed => "$R$ over speed", "$R$ über der Geschwindigkeit";
BracketNotUsed => "bracket not used", "Schranke nicht benutzt";
FitOfOneDegree => "fit of one degree of freedom", "Modell eines Freiheitsgrads";
FitOfOneDegreeFails => "fit of one degree of freedom (does not fit)", "Modell eines Freiheitsgrads (passt nicht)";
GrazingSimulated => "grazing $ρ$′, simulated", "Streifen $ρ$′, simuliert";
ImpactsUsed => "impacts used", "benutzte Stöße";
Measured => "measured", "gemessen";
MeasuredMotions => "measured $z$ = $p$/$n$:", "gemessen $z$ = $p$/$n$:";
MeasuredBracket => "measured bracket", "gemessene Schranke";
MeasuredWithStandardError => "measured, with standard error", "gemessen, mit Standardfehler";
NotModelled => "not modelled", "nicht im Modell";
NotUsed => "not used", "nicht benutzt";
OtherEdgeSimulated => "other edge, simulated", "anderer Rand, simuliert";
PaleNotUsed => "pale: not used", "blass: nicht benutzt";
PeriodDoublingSimulated => "period doubling $s_1$, simulated", "Periodenverdopplung $s_1$, simuliert";
PhasePortraits => "phase portraits", "Phasenporträts";
SaddleNodeSimulated => "saddle-node $s_2$, simulated", "Sattel-Knoten $s_2$, simuliert";
Simulated => "simulated", "simuliert";
RmsResidual => "{name}: rms residual {value} = {share} % of rms", "{name}: Residuum {value} (eff.) = {share} %";
// What hovering over a point shows
ConfidenceOf => "confidence {share}", "Sicherheit {share}";
ResidualOf => "residual {value}", "Residuum {value}";
SweepDown => "sweep down", "Durchlauf abwärts";
SweepUnknown => "sweep unknown", "Durchlauf unbekannt";
SweepUp => "sweep up", "Durchlauf aufwärts";
// Titles of figures
CorrelationOfTheParameters => "Correlation of the parameters", "Korrelation der Parameter";
EstimatesOfAllMethods => "Estimates of all methods", "Schätzungen aller Verfahren";
FreeDecaysAndTheirFits => "Free decays and their fits", "Ausschwingversuche und ihre Anpassungen";
BracketsAgainstBoundary => "Measured brackets against the fitted boundary", "Gemessene Schranken gegen die angepasste Grenze";
MotionsAndBoundaries => "Measured motions and boundaries", "Gemessene Bewegungen und Grenzen";
PointComparedTitle => "Point ({letter}): simulated and measured", "Punkt ({letter}): simuliert und gemessen";
ProfileLikelihoods => "Profile likelihoods", "Profil-Likelihoods";
RegionsSimulatedAndMeasured => "Regions of motion, simulated and measured", "Bewegungsgebiete, simuliert und gemessen";
ResidualDiagnostics => "Residual diagnostics", "Prüfung der Residuen";
ResonanceCurve => "Resonance curve without impacts", "Resonanzkurve ohne Stöße";
SpeedsAfterOverBeforeImpact => "Speeds after over before impact", "Geschwindigkeiten nach und vor dem Stoß";
// Motions, channels, parameters, methods
Beat => "beat", "Schwebung";
Chaotic => "chaotic", "chaotisch";
Sticking => "joined", "vereint";
Undetermined => "undetermined", "unbestimmt";
Edge => "edge", "Rand";
AccelerationX => "acceleration x", "Beschleunigung x";
AccelerationY => "acceleration y", "Beschleunigung y";
DisplacementX => "displacement x", "Weg x";
DisplacementY => "displacement y", "Weg y";
FrameX => "frame x", "Rahmen x";
FrameY => "frame y", "Rahmen y";
VelocityX => "velocity x", "Geschwindigkeit x";
VelocityY => "velocity y", "Geschwindigkeit y";
CornerOf => "corner of {channel}", "Grenzfrequenz {channel}";
GainOf => "gain of {channel}", "Verstärkung {channel}";
DelayOf => "delay of {channel}", "Verzögerung {channel}";
ClearanceDrift => "clearance drift", "Drift des Spiels";
ClearanceErrorOf => "error of clearance {number}", "Fehler von Spiel {number}";
ContactDuration => "contact duration", "Kontaktdauer";
ContactLaw => "contact law", "Kontaktgesetz";
DampingAsymmetry => "damping asymmetry", "Dämpfungsunterschied";
DampingDrift => "damping drift", "Drift der Dämpfung";
DeflectionDrift => "deflection drift", "Drift der Auslenkung";
DriveAsymmetry => "drive asymmetry", "Erregungsunterschied";
DriveHarmonic2Cos => "drive harmonic 2 cos", "Erregung, 2. Harmonische cos";
DriveHarmonic2Sin => "drive harmonic 2 sin", "Erregung, 2. Harmonische sin";
DriveHarmonic3Cos => "drive harmonic 3 cos", "Erregung, 3. Harmonische cos";
DriveHarmonic3Sin => "drive harmonic 3 sin", "Erregung, 3. Harmonische sin";
ForceCurve => "force curve", "Krümmung der Kraft";
ForceSlope => "force slope", "Steigung der Kraft";
FrequencyDrift => "frequency drift", "Drift der Eigenfrequenz";
FrequencyDriftBend => "frequency drift bend", "Krümmung der Frequenzdrift";
Friction => "friction", "Reibung";
Drag => "drag", "Widerstand";
SpringAsymmetry => "spring asymmetry", "Federasymmetrie";
PickupX => "pickup of mass x's channel", "Übersprechen auf den Kanal der Masse x";
PickupY => "pickup of mass y's channel", "Übersprechen auf den Kanal der Masse y";
HystereticDamping => "hysteretic share", "Anteil Strukturdämpfung";
Hardening => "hardening", "Verhärtung";
MassAsymmetry => "mass asymmetry", "Massenunterschied";
ScrewZero => "screw zero", "Nullpunkt der Schraube";
StiffnessAsymmetry => "stiffness asymmetry", "Steifigkeitsunterschied";
CoefficientOfRestitution => "coefficient of restitution", "Stoßzahl";
DampingRatio => "damping ratio", "Dämpfungsgrad";
NaturalFrequency => "natural frequency", "Eigenfrequenz";
StaticDeflection => "static deflection", "statische Auslenkung";
JointTitle => "Joint", "Gemeinsam";
Joint => "joint", "gemeinsam";
// First page
AgreementUnknown => "Agreement cannot be judged.", "Die Übereinstimmung ist nicht zu beurteilen.";
IdentifiedInPart => "Identified in part", "Zum Teil identifiziert";
Identified => "Identified: the model fits", "Identifiziert: Das Modell passt";
IdentifiedEachSpecimen => "Identified: the model fits each of the {count} specimens", "Identifiziert: Das Modell passt zu jedem der {count} Prüflinge";
IdentifiedRig => "Identified: the model fits the rig", "Identifiziert: Das Modell passt zum Prüfstand";
NotIdentifiableTitle => "Not identifiable from these data", "Aus diesen Daten nicht identifizierbar";
SyntheticData => "Synthetic data: simulated records, not a measurement.", "Synthetische Daten: simulierte Aufzeichnungen, keine Messung.";
MethodsAgree => "The methods agree.", "Die Verfahren stimmen überein.";
MethodsDisagree => "The methods disagree.", "Die Verfahren widersprechen einander.";
DoesNotFit => "The model does not fit", "Das Modell passt nicht";
RigDoesNotFit => "The model does not fit the rig", "Das Modell passt nicht zum Prüfstand";
FitsSomeSpecimens => "The model fits {some} of the {count} specimens", "Das Modell passt zu {some} der {count} Prüflinge";
WhatWasMeasured => "What was measured", "Was gemessen wurde";
NotDetermined => "not determined by these data", "von diesen Daten nicht bestimmt";
NotIdentifiable => "not identifiable", "nicht identifizierbar";
WeaklyIdentified => "weakly identified", "schwach bestimmt";
Range => "{first} to {last}", "{first} bis {last}";
Campaign => "campaign", "Messreihe";
Channels => "channels", "Kanäle";
Clearances => "clearances", "Spiele";
Laboratory => "laboratory", "Labor";
NominalValues => "nominal values", "Nennwerte";
Records => "records", "Aufzeichnungen";
Rig => "rig", "Prüfstand";
Sampling => "sampling", "Abtastung";
FromOneFile => ", from {count} file", ", aus {count} Datei";
FromFiles => ", from {count} files", ", aus {count} Dateien";
ImpactsDetected => "; {count} impacts detected", "; {count} Stöße erkannt";
DampingRatioSymbol => "damping ratio $β$", "Dämpfungsgrad $β$";
HighPassAt => "high-pass at {frequency} Hz", "Hochpass bei {frequency} Hz";
NaturalFrequencySymbol => "natural frequency $f_0$", "Eigenfrequenz $f_0$";
StaticDeflectionSymbol => "static deflection $x_st$", "statische Auslenkung $x_st$";
PublishedSpeeds => "approach speeds as published; nothing was measured here", "Annäherungsgeschwindigkeiten, wie veröffentlicht; hier wurde nichts gemessen";
OneMass => "one mass against a stop", "eine Masse gegen einen Anschlag";
TwoMasses => "two masses against each other", "zwei Massen gegeneinander";
UncertaintyOfTheGains => "uncertainty of the gains", "Unsicherheit der Verstärkungen";
ManyClearances => "{count} values of $r$ from {first} to {last}\u{2009}mm", "{count} Werte von $r$ von {first} bis {last}\u{2009}mm";
RecordLength => "{length}\u{2009}s a record", "{length}\u{2009}s je Aufzeichnung";
MeasuredFrequencies => "{low} to {high}\u{2009}Hz, as measured", "{low} bis {high}\u{2009}Hz, wie gemessen";
ReadAndUsed => "{read} read, {used} used", "{read} gelesen, {used} benutzt";
// Headings
AllRecords => "All records", "Alle Aufzeichnungen";
Appendix => "Appendix {letter}. {title}", "Anhang {letter}. {title}";
Conventions => "Conventions", "Vereinbarungen";
Figure => "Figure", "Bild";
MethodByMethod => "Method by method", "Die Verfahren im Einzelnen";
RegionsOfMotion => "Regions of motion", "Bewegungsgebiete";
SettingsVersionsInputs => "Settings, versions, inputs", "Einstellungen, Versionen, Eingaben";
SimulatedAndMeasuredMotions => "Simulated and measured motions", "Simulierte und gemessene Bewegungen";
SpecimenBySpecimen => "Specimen by specimen", "Die Prüflinge im Einzelnen";
WhatWasLeftOut => "What was left out, and why", "Was ausgelassen wurde, und warum";
// Captions of figures
CaptionBoundaryFit => "Boundary fit: each bracket, measured less simulated. A bracket that crosses zero agrees with the fit. Brackets of an upward sweep are drawn a little above their clearance, those of a downward sweep below.", "Anpassung der Grenzen: jede Schranke, gemessen minus simuliert. Eine Schranke über der Null stimmt mit dem Modell überein. Schranken eines Durchlaufs aufwärts stehen etwas über ihrem Spiel, die eines Durchlaufs abwärts darunter.";
CaptionStrips => "Clearances far above all impacts are drawn in a strip of their own.", "Spiele weit über allen Stößen stehen in einem eigenen Streifen.";
CaptionCorrelation => "Correlation of the joint estimates. Strong correlation means that the data tell a combination of the two better than either.", "Korrelation der gemeinsamen Schätzungen. Starke Korrelation heißt, dass die Daten eine Verbindung der beiden besser bestimmen als jede allein.";
CaptionCorrelationOthers => "The correlations of the other fitted quantities are in correlation.csv.", "Die Korrelationen der übrigen angepassten Größen stehen in correlation.csv.";
CaptionComparisons => "Each point as simulated with the fitted parameters (left) and as measured (middle), on the same scales, with the residual (measured less simulated) and the phase portraits (simulated: broad and pale; measured: thin and dark). Mass $x$ is blue, mass $y$ vermilion; dotted lines are impacts. The drift of a measured motion is that of its record alone, from one period to the next; all motions are shown about their means. Scale and size of the residual leave out the samples of a contact.", "Jeder Punkt, wie mit den angepassten Parametern simuliert (links) und wie gemessen (Mitte), in gleichen Maßstäben, mit dem Residuum (gemessen minus simuliert) und den Phasenporträts (simuliert: breit und blass; gemessen: schmal und dunkel). Masse $x$ ist blau, Masse $y$ zinnoberrot; punktierte Linien sind Stöße. Die Drift einer gemessenen Bewegung ist die ihrer Aufzeichnung allein, von einer Periode zur nächsten; alle Bewegungen sind um ihre Mittelwerte dargestellt. Maßstab und Größe des Residuums lassen die Abtastwerte eines Kontakts aus.";
CaptionCells => "Every cell simulated from rest and from a lively start, and the stable orbits z = 1/n in closed form; where they differ, both motions exist.", "Jede Zelle aus der Ruhe und aus einem lebhaften Anfang simuliert, dazu die stabilen Bewegungen z = 1/n in geschlossener Form; wo sie sich unterscheiden, gibt es beide Bewegungen.";
CaptionDecays => "Free decays (black) and their fits (vermilion), with natural frequency and damping ratio ± standard error.", "Ausschwingversuche (schwarz) und ihre Anpassungen (zinnoberrot), mit Eigenfrequenz und Dämpfungsgrad ± Standardfehler.";
CaptionOtherMotion => "From none of the starts tried does the fitted model settle on the measured motion.", "Aus keinem der versuchten Anfänge geht das angepasste Modell in die gemessene Bewegung über.";
CaptionBoundariesAlone => "The measured boundaries alone, with all that may act on them, give $R$ = {boundaries}; all methods together give {joint} (95 %).", "Die gemessenen Grenzen allein, mit allem, was auf sie wirken kann, ergeben $R$ = {boundaries}; alle Verfahren zusammen {joint} (95 %).";
CaptionBands => "Grey bands: 95 % bands of the simulated boundaries.", "Graue Bänder: 95-%-Bänder der simulierten Grenzen.";
CaptionLetters => "Letters: the points compared in the next figures.", "Buchstaben: die Punkte, die in den nächsten Bildern verglichen werden.";
CaptionMap => "Measured motions in the plane of frequency and clearance. Each mark is a record; marks of an upward sweep are drawn a little above their clearance, those of a downward sweep a little below.", "Gemessene Bewegungen in der Ebene von Frequenz und Spiel. Jedes Zeichen ist eine Aufzeichnung; Zeichen eines Durchlaufs aufwärts stehen etwas über ihrem Spiel, die eines Durchlaufs abwärts etwas darunter.";
CaptionPoint => "Point ({letter})", "Punkt ({letter})";
CaptionSetting => ", at $η$ = {eta}, $ρ$ = {rho}", ", bei $η$ = {eta}, $ρ$ = {rho}";
CaptionRecord => "; record {record}.", "; Aufzeichnung {record}.";
CaptionSimulatedMotion => "The simulated motion is {motion}.", "Die simulierte Bewegung ist {motion}.";
CaptionProfiles => "Profile likelihoods: the rise of $χ$² when one parameter is held and the others are fitted again. Tinted: 95 % intervals; dashed: the rise of {rise} that bounds them.", "Profil-Likelihoods: der Anstieg von $χ$², wenn ein Parameter festgehalten und die anderen neu angepasst werden. Getönt: 95-%-Intervalle; gestrichelt: der Anstieg von {rise}, der sie begrenzt.";
CaptionResonance => "Resonance curve of the motion without impacts, measured and fitted.", "Resonanzkurve der Bewegung ohne Stöße, gemessen und angepasst.";
CaptionImpacts => "Speeds at impact: separation speed over approach speed (left) and their ratio, the restitution, over the approach speed (right).", "Stoßgeschwindigkeiten: Geschwindigkeit der Trennung über der der Annäherung (links) und ihr Verhältnis, die Stoßzahl, über der Geschwindigkeit der Annäherung (rechts).";
CaptionRegions => "Tinted regions: simulated with the fitted parameters, labelled by $z$ = $p$/$n$; hatched, with two labels, where two motions are possible (hysteresis).", "Getönte Gebiete: mit den angepassten Parametern simuliert, bezeichnet mit $z$ = $p$/$n$; schraffiert und mit zwei Bezeichnungen, wo zwei Bewegungen möglich sind (Hysterese).";
CaptionAlikeInKind => "Two runs of such a motion diverge: they agree in character, not point by point.", "Zwei Läufe einer solchen Bewegung laufen auseinander: Sie stimmen im Charakter überein, nicht Punkt für Punkt.";
CaptionResiduals => "{method}, residual diagnostics ({count} residuals over their standard errors): histogram with the normal curve, autocorrelation with the 95 % band of white noise, over frequency and over gap.", "{method}, Prüfung der Residuen ({count} Residuen durch ihre Standardfehler): Histogramm mit der Normalverteilung, Autokorrelation mit dem 95-%-Band weißen Rauschens, über Frequenz und Spiel.";
// Tables
TablePublished => "Approach speeds at impact, dimensionless: as published, and as the model has them for the damping ratio found and for those printed.", "Dimensionslose Annäherungsgeschwindigkeiten beim Stoß: wie veröffentlicht, und wie sie das Modell für den gefundenen und für die gedruckten Dämpfungsgrade ergibt.";
PublishedSpeed => "published speed", "veröffentlichte Geschwindigkeit";
TableAgreement => "Agreement of the methods, pair by pair. Each p-value is that of its pair alone, not corrected for the number of comparisons; the methods disagree where one is below {level} divided by that number, {count}.", "Übereinstimmung der Verfahren, Paar für Paar. Jeder p-Wert ist der seines Paares allein, nicht um die Zahl der Vergleiche berichtigt; die Verfahren widersprechen sich, wo einer unter {level}, geteilt durch diese Zahl, {count}, liegt.";
TableRecordsByMethod => "All records, and which methods used them.", "Alle Aufzeichnungen, und welche Verfahren sie benutzten.";
TableRecords => "All records: sweep, measured drive frequency, clearance, motion and confidence.", "Alle Aufzeichnungen: Durchlauf, gemessene Erregerfrequenz, Spiel, Bewegung und Sicherheit.";
TableMethods => "Estimates with half their 95 % interval, number of observations, root mean square of the weighted residuals (1: as the stated noise), and whether the model fits.", "Schätzungen mit der Hälfte ihres 95-%-Intervalls, Zahl der Beobachtungen, Effektivwert der gewichteten Residuen (1: wie das angegebene Rauschen), und ob das Modell passt.";
TableBrackets => "Measured brackets of the boundaries, and the boundary of the fitted model.", "Gemessene Schranken der Grenzen, und die Grenze des angepassten Modells.";
TableManyBrackets => "Measured brackets of the boundaries, and the boundary of the fitted model: = within the bracket, < below, > above it; × not used in the fit.", "Gemessene Schranken der Grenzen, und die Grenze des angepassten Modells: = in der Schranke, < darunter, > darüber; × in der Anpassung nicht benutzt.";
TableHashes => "SHA-256 of every input.", "SHA-256 jeder Eingabe.";
TableManyRecords => "{records}: sweep, measured drive frequency, clearance, motion, confidence. ? undetermined; • used in the identification; ! flagged. Reasons and flags in full are in records.parquet.", "{records}: Durchlauf, gemessene Erregerfrequenz, Spiel, Bewegung, Sicherheit. ? unbestimmt; • in der Identifikation benutzt; ! mit Vermerk. Gründe und Vermerke stehen vollständig in records.parquet.";
SomeRecords => "{some} of the {count} records, evenly chosen (records.parquet holds all)", "{some} der {count} Aufzeichnungen, gleichmäßig gewählt (records.parquet hat alle)";
AboveBy => "above by {distance} Hz", "um {distance} Hz darüber";
AndMethod => "and method", "und Verfahren";
BelowBy => "below by {distance} Hz", "um {distance} Hz darunter";
Boundary => "boundary", "Grenze";
ConfidenceShort => "conf.", "Sich.";
Count => "count", "Zahl";
DifferenceOverError => "difference / its error", "Unterschied / Fehler";
Fits => "fits", "passt";
Impacts => "impacts", "Stöße";
Input => "input", "Eingabe";
LeftOut => "left out", "ausgelassen";
MeasuredBetween => "measured between", "gemessen zwischen";
Method => "method", "Verfahren";
MotionUndetermined => "motion undetermined", "Bewegung unbestimmt";
No => "no", "nein";
NotUsedBecause => "not used: {why}", "nicht benutzt: {why}";
ObservationsShort => "obs.", "Beob.";
PValue => "p-value", "p-Wert";
Parameter => "parameter", "Parameter";
Record => "record", "Aufzeichnung";
Remark => "remark", "Bemerkung";
Specimen => "specimen", "Prüfling";
Sweep => "sweep", "Durchlauf";
UsedByAndFlags => "used by; flags", "benutzt von; Vermerke";
Verdict => "verdict", "Urteil";
Why => "why", "warum";
Within => "within", "darin";
Yes => "yes", "ja";
DetailsOfOne => "{details} (in {record}; similar in the others)", "{details} (in {record}; in den anderen ähnlich)";
// Conventions and settings
MeaningOfMotion => "$p$ impacts in $n$ drive periods; 1j: a dead zone follows the impact", "$p$ Stöße in $n$ Erregerperioden; 1j: Auf den Stoß folgt eine Totzone";
IntervalsAndUnits => "Intervals are at 95 % confidence; a number after ± is half of that interval. All quantities are in SI units.", "Intervalle haben 95 % Sicherheit; eine Zahl nach ± ist die Hälfte eines solchen Intervalls. Alle Größen stehen in SI-Einheiten.";
SettingsAsResolved => "Settings, as resolved:", "Einstellungen, wie aufgelöst:";
CommandAgain => "The command that makes this report again:", "Der Befehl, der diesen Bericht wieder macht:";
Versions => "Versions of program and files: {list}.", "Versionen von Programm und Dateien: {list}.";
MeaningOfClearanceRatio => "clearance ratio; the gap between the masses is 2$r$", "Spielverhältnis; der Abstand der Massen ist 2$r$";
MeaningOfRestitution => "coefficient of restitution: separation speed over approach speed where the bodies touch; waveforms and boundaries tell it of the whole bodies, which differs where a body vibrates in itself", "Stoßzahl: Geschwindigkeit der Trennung durch Geschwindigkeit der Annäherung an der Stoßstelle; Zeitverläufe und Grenzen geben sie für die ganzen Körper an, was sich unterscheidet, wo ein Körper in sich schwingt";
MeaningOfDampingRatio => "damping ratio of a mass $m$ on a spring $k$ with viscous damping $b$", "Dämpfungsgrad einer Masse $m$ an einer Feder $k$ mit zäher Dämpfung $b$";
MeaningOfFrequencyRatio => "frequency ratio of the drive", "Frequenzverhältnis der Erregung";
MeaningOfEquation => "motion of each mass between impacts, $X$ = $x$/$x_st$; impact where $X$ + $Y$ ≥ 2$ρ$", "Bewegung jeder Masse zwischen Stößen, $X$ = $x$/$x_st$; Stoß, wo $X$ + $Y$ ≥ 2$ρ$";
MeaningOfStaticDeflection => "static deflection under the drive's amplitude $F_0$", "statische Auslenkung unter der Amplitude $F_0$ der Erregung";
MeaningOfTime => "time counted in natural angle, Ω = √($k$/$m$) = 2π$f_0$", "Zeit, gezählt im Eigenwinkel, Ω = √($k$/$m$) = 2π$f_0$";
// Buttons of the page
SaveAsSVG => "save as SVG", "als SVG speichern";
WholeFigure => "whole figure", "ganzes Bild";
ZoomIn => "zoom in", "vergrößern";
ZoomOut => "zoom out", "verkleinern";}

/// A text of a figure: a phrase, a phrase with a unit or a count behind it, or a text that is the same
/// in every language.
#[derive(Debug, Clone, PartialEq)]
pub enum Text {
    /// A phrase.
    Phrase(Phrase),
    /// A phrase and what follows it.
    Followed(Phrase, String),
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

/// The name of what a channel measures.
pub(crate) fn role_text(role: Role) -> Text {
    match role {
        Role::Drive => Phrase::Drive,
        Role::Contact => Phrase::Contact,
        Role::VelocityX => Phrase::VelocityX,
        Role::VelocityY => Phrase::VelocityY,
        Role::DisplacementX => Phrase::DisplacementX,
        Role::DisplacementY => Phrase::DisplacementY,
        Role::AccelerationX => Phrase::AccelerationX,
        Role::AccelerationY => Phrase::AccelerationY,
        Role::FrameX => Phrase::FrameX,
        Role::FrameY => Phrase::FrameY,
    }
    .into()
}
