//! Units of measurement and their factors to SI, and quantities written as text.
//!
//! ```
//! use labfiles::units::{Dimension, parse_quantity_of};
//! assert_eq!(parse_quantity_of("1.5 mm", Dimension::Length), Ok(1.5e-3));
//! assert!(parse_quantity_of("1.5 mm", Dimension::Time).is_err());
//! ```

mod quantity;
mod scale;
mod table;

pub use quantity::{Quantity, QuantityError, parse_quantity, parse_quantity_of};
pub use scale::{Scale, parse_scale};
pub use table::{
    Dimension, STANDARD_GRAVITY_M_S2, Unit, parse_split_unit, parse_unit, split_unit, symbol_of,
    symbols_of, unit_of,
};
pub(crate) use table::{split_at_comma, split_at_slash, without_slash};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_units_have_their_si_factors() {
        assert_eq!(parse_unit(" mm ").unwrap().to_si, 1e-3);
        assert_eq!(parse_unit("g").unwrap().to_si, 9.80665);
        let hz = parse_unit("rad/s").unwrap();
        assert!((hz.to_si * std::f64::consts::TAU - 1.0).abs() < 1e-15);
        assert!(parse_unit("furlong").is_none());
    }

    #[test]
    fn quantities_are_read_in_si() {
        let read = |text| parse_quantity(text).unwrap();
        assert_eq!(
            read("1.5 mm"),
            Quantity {
                si: 1.5e-3,
                dimension: Dimension::Length
            }
        );
        assert_eq!(read("-2e-3m").si, -2e-3);
        assert_eq!(
            read("0.5 %"),
            Quantity {
                si: 0.005,
                dimension: Dimension::Number
            }
        );
        assert_eq!(read("7").dimension, Dimension::Number);
        assert!(matches!(
            parse_quantity("1,5 mm"),
            Err(QuantityError::Comma(_))
        ));
        assert!(matches!(
            parse_quantity("mm"),
            Err(QuantityError::NoNumber(_))
        ));
        assert!(matches!(
            parse_quantity("1 mmm"),
            Err(QuantityError::UnknownUnit(_))
        ));
        assert!(matches!(
            parse_quantity("1e999 m"),
            Err(QuantityError::NotFinite(_))
        ));
        let wrong = parse_quantity_of("3 kg", Dimension::Length);
        assert!(matches!(wrong, Err(QuantityError::Dimension { .. })));
    }

    #[test]
    fn scales_work_both_ways_round() {
        let volt = parse_unit("V").unwrap();
        for text in [
            "50 mm/s per V",
            "0.05 m/s/V",
            "20 V/(m/s)",
            "20 V per m/s",
            "20 V/m/s",
        ] {
            let unit = parse_scale(text).unwrap().apply(volt).unwrap();
            assert_eq!(unit.dimension, Dimension::Velocity, "{text}");
            assert!((unit.to_si - 0.05).abs() < 1e-15, "{text}");
        }
        let g = parse_scale("100 mV/g").unwrap().apply(volt).unwrap();
        assert!((g.to_si - 98.0665).abs() < 1e-12);
        assert_eq!(parse_scale("0.5").unwrap(), Scale::Factor(0.5));
        assert!(matches!(
            parse_scale("5 mm/s"),
            Err(QuantityError::NoRatio(_))
        ));
        assert!(
            parse_scale("5 mm per V")
                .unwrap()
                .apply(parse_unit("N").unwrap())
                .is_none()
        );
    }

    #[test]
    fn units_are_split_off_names() {
        assert_eq!(split_unit("clearance [mm]"), ("clearance", Some("mm")));
        assert_eq!(split_unit("clearance_mm"), ("clearance", Some("mm")));
        assert_eq!(split_unit("clearance in mm"), ("clearance", Some("mm")));
        assert_eq!(split_unit("gap / mm"), ("gap", Some("mm")));
        assert_eq!(split_unit("v/(m/s)"), ("v", Some("m/s")));
        assert_eq!(split_unit("v / m/s"), ("v", Some("m/s")));
        assert_eq!(split_unit("m/s"), ("m/s", None));
        assert_eq!(split_unit("left/right"), ("left/right", None));
        assert_eq!(split_unit("laser in use"), ("laser in use", None));
        assert_eq!(split_unit("Load, lbf"), ("Load", Some("lbf")));
        assert_eq!(split_unit("Sensor, 1"), ("Sensor, 1", None));
        assert_eq!(split_unit("Position, Ch 1"), ("Position, Ch 1", None));
        assert_eq!(
            split_unit("drive_frequency_hz"),
            ("drive_frequency", Some("hz"))
        );
        assert_eq!(split_unit("speed_m_s"), ("speed", Some("m_s")));
        assert_eq!(split_unit("drive_frequency"), ("drive_frequency", None));
        assert_eq!(
            parse_split_unit("hz").unwrap().dimension,
            Dimension::Frequency
        );
        assert_eq!(
            parse_split_unit("m_s").unwrap().dimension,
            Dimension::Velocity
        );
    }

    proptest::proptest! {
        #[test]
        fn prop_no_text_panics(text in "\\PC{0,30}") {
            let _ = (parse_quantity(&text), parse_scale(&text), split_unit(&text));
        }
    }
}
