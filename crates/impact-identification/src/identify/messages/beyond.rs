//! Texts on the effects beyond the model.

use crate::identify::parameters::effect::Effect;
use impact_records::texts;

/// An effect beyond the model, and what can be done about it, in English and in German; `rises`:
/// whether its strength is positive.
#[expect(clippy::too_many_lines, reason = "one arm for each effect")]
pub(super) fn beyond(effect: Effect, rises: bool) -> [&'static str; 2] {
    texts! { (effect, rises);
        (Effect::SecondHarmonicCos | Effect::SecondHarmonicSin, _) =>
            "the driving force has a second harmonic of {strength} ± {error} % of its amplitude: \
             check the amplifier, and that the drive current is not rectified",
            "die Antriebskraft hat eine zweite Oberwelle von {strength} ± {error} % ihrer \
             Amplitude: den Verstärker prüfen, und ob der Antriebsstrom gleichgerichtet wird";
        (Effect::ThirdHarmonicCos | Effect::ThirdHarmonicSin, _) =>
            "the driving force has a third harmonic of {strength} ± {error} % of its amplitude: \
             drive the amplifier less hard",
            "die Antriebskraft hat eine dritte Oberwelle von {strength} ± {error} % ihrer \
             Amplitude: den Verstärker weniger aussteuern";
        (Effect::ForceSlope, true) =>
            "the driving force rises by {strength} ± {error} % per natural frequency: record the \
             force or the current",
            "die Antriebskraft steigt um {strength} ± {error} % je Eigenfrequenz: die Kraft oder \
             den Strom aufzeichnen";
        (Effect::ForceSlope, false) =>
            "the driving force falls by {strength} ± {error} % per natural frequency: record the \
             force or the current",
            "die Antriebskraft sinkt um {strength} ± {error} % je Eigenfrequenz: die Kraft oder \
             den Strom aufzeichnen";
        (Effect::ForceCurve, _) =>
            "the driving force against frequency is curved, by {strength} ± {error} % one natural \
             frequency off resonance: record the force or the current",
            "die Antriebskraft ist über der Frequenz gekrümmt, um {strength} ± {error} % eine \
             Eigenfrequenz neben der Resonanz: die Kraft oder den Strom aufzeichnen";
        (Effect::Hardening, true) =>
            "the springs harden by {strength} ± {error} % at the greatest displacement: use \
             smaller motions or longer springs",
            "die Federn versteifen sich um {strength} ± {error} % beim größten Weg: kleinere \
             Bewegungen oder längere Federn";
        (Effect::Hardening, false) =>
            "the springs soften by {strength} ± {error} % at the greatest displacement: check \
             their clamps, or use smaller motions",
            "die Federn werden um {strength} ± {error} % weicher beim größten Weg: ihre \
             Einspannungen prüfen, oder kleinere Bewegungen";
        (Effect::Friction, true) =>
            "there is dry friction of {strength} ± {error} % of the driving force: look for \
             cables, guides and loose clamps",
            "es gibt trockene Reibung von {strength} ± {error} % der Antriebskraft: Kabel, \
             Führungen und lose Einspannungen suchen";
        (Effect::Friction, false) =>
            "the damping grows faster than the velocity, as with air drag (dry friction of \
             −{strength} ± {error} % of the driving force)",
            "die Dämpfung wächst schneller als die Geschwindigkeit, wie bei Luftwiderstand \
             (trockene Reibung von −{strength} ± {error} % der Antriebskraft)";
        (Effect::FrequencyDrift, true) =>
            "the natural frequency rises by {strength} ± {error} % over the campaign: check \
             clamps and temperature",
            "die Eigenfrequenz steigt um {strength} ± {error} % während der Messreihe: \
             Einspannungen und Temperatur prüfen";
        (Effect::FrequencyDrift, false) =>
            "the natural frequency falls by {strength} ± {error} % over the campaign: check \
             clamps and temperature",
            "die Eigenfrequenz sinkt um {strength} ± {error} % während der Messreihe: \
             Einspannungen und Temperatur prüfen";
        (Effect::FrequencyBend, _) =>
            "the natural frequency in the middle of the campaign is off that of both ends by \
             twice {strength} ± {error} %: check clamps and temperature",
            "die Eigenfrequenz in der Mitte der Messreihe weicht von der an beiden Enden um \
             zweimal {strength} ± {error} % ab: Einspannungen und Temperatur prüfen";
        (Effect::DampingDrift, true) =>
            "the damping ratio rises by {strength} ± {error} % over the campaign: check clamps \
             and temperature",
            "der Dämpfungsgrad steigt um {strength} ± {error} % während der Messreihe: \
             Einspannungen und Temperatur prüfen";
        (Effect::DampingDrift, false) =>
            "the damping ratio falls by {strength} ± {error} % over the campaign: check clamps \
             and temperature",
            "der Dämpfungsgrad sinkt um {strength} ± {error} % während der Messreihe: \
             Einspannungen und Temperatur prüfen";
        (Effect::DeflectionDrift, true) =>
            "the static deflection rises by {strength} ± {error} % over the campaign: check the \
             amplifier and the springs",
            "die statische Auslenkung steigt um {strength} ± {error} % während der Messreihe: \
             Verstärker und Federn prüfen";
        (Effect::DeflectionDrift, false) =>
            "the static deflection falls by {strength} ± {error} % over the campaign: check the \
             amplifier and the springs",
            "die statische Auslenkung sinkt um {strength} ± {error} % während der Messreihe: \
             Verstärker und Federn prüfen";
        (Effect::ClearanceDrift, true) =>
            "the gaps widen by {strength} ± {error} % of the static deflection over the campaign: \
             check clamps and temperature of the frame",
            "das Spiel wächst während der Messreihe um {strength} ± {error} % der statischen \
             Auslenkung: Einspannungen und Temperatur des Rahmens prüfen";
        (Effect::ClearanceDrift, false) =>
            "the gaps narrow by {strength} ± {error} % of the static deflection over the \
             campaign: check clamps and temperature of the frame",
            "das Spiel schrumpft während der Messreihe um {strength} ± {error} % der statischen \
             Auslenkung: Einspannungen und Temperatur des Rahmens prüfen";
        (Effect::ContactLaw, _) =>
            "a contact's length changes the speeds by {strength} ± {error} % otherwise than a \
             spring and a damper would",
            "die Dauer eines Kontakts ändert die Geschwindigkeiten um {strength} ± {error} % \
             anders als eine Feder und ein Dämpfer";
        (Effect::ContactReach, _) =>
            "in contact, the masses' acceleration adds {strength} ± {error} % of its share to how \
             far they press into each other: use harder bumpers",
            "im Kontakt erhöht die Beschleunigung der Massen um {strength} ± {error} % ihres \
             Anteils, wie weit sie ineinander eindringen: härtere Puffer verwenden";
        (Effect::ContactSpeed, false) =>
            "contacts grow longer with the speed, with an exponent of {strength} ± {error} %: look at the bumpers",
            "Kontakte werden mit der Geschwindigkeit länger, mit einem Exponenten von {strength} ± {error} %: Puffer \
             prüfen";
        (Effect::ContactSpeed, true) =>
            "contacts grow shorter with the speed, with an exponent of {strength} ± {error} %, as those of \
             round bumpers do",
            "Kontakte werden mit der Geschwindigkeit kürzer, mit einem Exponenten von {strength} ± {error} %, wie \
             die runder Puffer";
        (Effect::RestitutionSpeed, true) =>
            "R rises by {strength} ± {error} % for each factor 2.7 of the approach speed; it is stated at the median \
             speed of the impacts",
            "R steigt um {strength} ± {error} % je Faktor 2,7 der Auftreffgeschwindigkeit; angegeben ist es beim Median \
             der Geschwindigkeiten der Stöße";
        (Effect::RestitutionSpeed, false) =>
            "R falls by {strength} ± {error} % for each factor 2.7 of the approach speed; it is stated at the median \
             speed of the impacts",
            "R sinkt um {strength} ± {error} % je Faktor 2,7 der Auftreffgeschwindigkeit; angegeben ist es beim Median \
             der Geschwindigkeiten der Stöße";
        (Effect::ContactDuration, _) =>
            "a contact acts like one of {strength} ± {error} ms: use harder bumpers",
            "ein Kontakt wirkt wie einer von {strength} ± {error} ms: härtere Puffer verwenden";
        (Effect::Drag, true) =>
            "there is drag that grows with the square of the velocity, of {strength} ± {error} % \
             of the driving force at the greatest displacement: use smaller motions, or guides \
             without flat faces",
            "es gibt einen Widerstand, der mit dem Quadrat der Geschwindigkeit wächst, von \
             {strength} ± {error} % der Antriebskraft beim größten Weg: kleinere Bewegungen, oder \
             Führungen ohne flache Stirnseiten";
        (Effect::Drag, false) =>
            "the damping grows slower than the velocity (a quadratic part of −{strength} ± \
             {error} % of the driving force at the greatest displacement): look for slip in \
             joints",
            "die Dämpfung wächst langsamer als die Geschwindigkeit (ein quadratischer Anteil von \
             −{strength} ± {error} % der Antriebskraft beim größten Weg): Schlupf in Verbindungen \
             suchen";
        (Effect::SpringAsymmetry, true) =>
            "the springs are stiffer toward the other mass, by {strength} ± {error} % at the \
             greatest displacement: check that they are straight at rest",
            "die Federn sind zur anderen Masse hin steifer, um {strength} ± {error} % beim \
             größten Weg: prüfen, ob sie in Ruhe gerade sind";
        (Effect::SpringAsymmetry, false) =>
            "the springs are softer toward the other mass, by {strength} ± {error} % at the \
             greatest displacement: check that they are straight at rest",
            "die Federn sind zur anderen Masse hin weicher, um {strength} ± {error} % beim \
             größten Weg: prüfen, ob sie in Ruhe gerade sind";
        (Effect::PickupX, _) =>
            "the channel of mass x picks up {strength} ± {error} % of its greatest amplitude from \
             the drive's generator: keep their cables apart, and connect their grounds at one point",
            "der Kanal der Masse x nimmt {strength} ± {error} % seines größten Ausschlags vom \
             Generator der Erregung auf: die Kabel trennen und ihre Bezugspotentiale an einem Punkt \
             verbinden";
        (Effect::PickupY, _) =>
            "the channel of mass y picks up {strength} ± {error} % of its greatest amplitude from \
             the drive's generator: keep their cables apart, and connect their grounds at one point",
            "der Kanal der Masse y nimmt {strength} ± {error} % seines größten Ausschlags vom \
             Generator der Erregung auf: die Kabel trennen und ihre Bezugspotentiale an einem Punkt \
             verbinden";
        (Effect::HystereticDamping, true) =>
            "a share of {strength} ± {error} % of the damping falls with the drive's frequency, \
             as that inside of springs does (hysteretic damping): the damping ratio holds at \
             resonance",
            "ein Anteil von {strength} ± {error} % der Dämpfung sinkt mit der Erregerfrequenz, \
             wie der im Inneren von Federn (Strukturdämpfung): der Dämpfungsgrad gilt bei \
             Resonanz";
        (Effect::HystereticDamping, false) =>
            "the damping rises with the drive's frequency (a hysteretic share of −{strength} ± \
             {error} %): the damping ratio holds at resonance",
            "die Dämpfung steigt mit der Erregerfrequenz (ein Anteil an Strukturdämpfung von \
             −{strength} ± {error} %): der Dämpfungsgrad gilt bei Resonanz";
    }
}
