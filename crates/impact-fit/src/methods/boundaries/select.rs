//! Which brackets the boundaries rest on.

use crate::messages::Reason;
use crate::methods::boundaries::block::predicted_hz;
use crate::methods::selection::Selection;
use crate::parameters::Parameters;
use impact_records::motion::Bracket;

impl Selection<'_> {
    /// Choose the brackets: those that no boundary reaches, or that lie far from it, are left out and named.
    pub fn choose_brackets(&mut self, start: &Parameters) {
        let rig = self.evidence.rig;
        let far = |bracket: &mut Bracket| {
            let predicted = predicted_hz(bracket, start, rig);
            !predicted.is_some_and(|f| {
                (f - bracket.middle_hz()).abs() <= 3.0 * bracket.width_hz() + 0.02 * f
            })
        };
        let brackets = &mut self.blocks.boundary.brackets;
        for bracket in brackets.extract_if(.., far).collect::<Vec<_>>() {
            self.note_bracket(&bracket, Reason::FarFromBoundary);
        }
        self.blocks.boundary.fit_early_scale(start);
    }
}
