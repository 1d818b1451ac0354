use impactid::event::{Rig, detect::DetectSettings};
use impactid::motion::{ClassifySettings, observe};
use impactid::synthetic::*;
fn main() {
    let a: Vec<f64> = std::env::args()
        .skip(1)
        .map(|s| s.parse().unwrap())
        .collect();
    let (seed, r, b, f, n) = (a[0] as u64, a[1], a[2], a[3], a[4] as usize);
    let faults = Faults::default();
    let (da, sa) = truth::draw_asymmetry(&faults, seed);
    let truth = Truth {
        restitution: r,
        natural_frequency_hz: f,
        damping_ratio: b,
        static_deflection_m: 5e-4,
        drive_asymmetry: da,
        stiffness_asymmetry: sa,
    };
    let plan = Plan::for_rig(f, b, 5e-4, n);
    let t0 = std::time::Instant::now();
    let raw = records(&truth, &faults, &plan, seed).unwrap();
    eprintln!("simulated {:?}", t0.elapsed());
    let t0 = std::time::Instant::now();
    let (mut right, mut periodic, mut wrong_sure, mut und) = (0, 0, 0, 0);
    let mut rs = vec![];
    let mut obs = vec![];
    for rec in &raw {
        let record = run::calibrated(rec, &truth, &faults);
        let o = observe(
            &record,
            Rig::Double,
            &DetectSettings::default(),
            &ClassifySettings::default(),
        );
        let got = o.finding.motion.label();
        let mut o2 = o.clone();
        o2.setting.sequence = obs.len();
        obs.push(o2);
        let want = rec.motion.label();
        if rec.motion.is_periodic() {
            periodic += 1;
            if got == want {
                right += 1
            } else if o.finding.is_sure() {
                wrong_sure += 1
            }
            if got == "undetermined" {
                und += 1
            }
        }
        // impacts vs truth
        for i in &o.impacts {
            if let (Some(x), Some(y)) = (i.closing_speed_before_m_s, i.closing_speed_after_m_s) {
                let t = rec
                    .impacts
                    .iter()
                    .min_by(|p, q| (p.0 - i.time_s).abs().total_cmp(&(q.0 - i.time_s).abs()));
                if let Some(t) = t {
                    rs.push((
                        -y / x,
                        (t.0 - i.time_s),
                        i.time_error_s,
                        x - t.1,
                        i.speed_error_m_s.unwrap(),
                        x,
                    ));
                }
            }
        }
        if std::env::var("REC").is_ok_and(|r| r == rec.id) {
            for i in &o.impacts {
                println!("{:?}", i);
            }
            println!("{:?}", rec.impacts);
        }
        let bad = rec.motion.is_periodic() && got != want;
        if bad || std::env::var("ALL").is_ok() {
            println!(
                "{} f {:.2} eta {:.3} rho {:.2} {:?} truth {} ({}) got {} conf {:.2} {:?} true impacts {} un {} miss {}",
                rec.id,
                rec.step.frequency_hz,
                rec.step.frequency_hz / f,
                rec.step.clearance_m / 5e-4,
                rec.step.sweep,
                want,
                rec.motion.is_periodic(),
                got,
                o.finding.confidence,
                o.finding.evidence,
                rec.impacts.len(),
                o.unsupported_pulses,
                o.missed_pulses
            );
            if let impactid::motion::Motion::Undetermined { reason } = &o.finding.motion {
                println!("    {reason}");
            }
        }
    }
    eprintln!("observed {:?}", t0.elapsed());
    println!(
        "periodic {periodic} of {} right {right} ({:.2}%) wrong but sure {wrong_sure} undetermined {und}",
        raw.len(),
        100.0 * right as f64 / periodic as f64
    );
    rs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let m = rs.len();
    println!(
        "impacts {m} R median {:.5} q05 {:.4} q95 {:.4}",
        rs[m / 2].0,
        rs[m / 20].0,
        rs[m - m / 20].0
    );
    let tz = (rs.iter().map(|r| (r.1 / r.2).powi(2)).sum::<f64>() / m as f64).sqrt();
    let mut ez: Vec<f64> = rs.iter().map(|r| (r.1 / r.2).abs()).collect();
    ez.sort_by(f64::total_cmp);
    let mut te: Vec<f64> = rs.iter().map(|r| r.1.abs()).collect();
    te.sort_by(f64::total_cmp);
    let mut se: Vec<f64> = rs.iter().map(|r| (r.3 / r.4).abs()).collect();
    se.sort_by(f64::total_cmp);
    println!(
        "time rms z {tz:.2}; median |z| {:.2} q95 {:.2}; time err median {:.2e} q95 {:.2e}; speed |z| median {:.2} q95 {:.2}",
        ez[m / 2],
        ez[m * 95 / 100],
        te[m / 2],
        te[m * 95 / 100],
        se[m / 2],
        se[m * 95 / 100]
    );

    let t0 = std::time::Instant::now();
    let brackets = impactid::motion::brackets(&obs);
    let ev = impactid::identify::methods::Evidence {
        rig: Rig::Double,
        observations: &obs,
        brackets: &brackets,
        nominal: impactid::identify::methods::Nominal {
            gain_uncertainty: 0.005,
            ..Default::default()
        },
    };
    let out = impactid::identify::run::identify(&ev);
    eprintln!("identified {:?}", t0.elapsed());
    println!("truth {truth:?}");
    if std::env::var("BR").is_ok() {
        for b in &brackets {
            println!(
                "{:?} n{} r {:.2} {:.2}-{:.2} {:?} {}->{} pred {:?}",
                b.kind,
                b.periods_n,
                b.clearance_m / 5e-4,
                b.frequency_low_hz,
                b.frequency_high_hz,
                b.sweep,
                b.from,
                b.to,
                out.fit
                    .as_ref()
                    .and_then(|f| impactid::identify::boundary::predicted_hz(
                        b,
                        &f.parameters,
                        Rig::Double
                    ))
            );
        }
    }
    let show = |name: &str, m: &impactid::identify::MethodResult| {
        println!(
            "-- {name}: n {} rec {} chi {:?} fits {:?}",
            m.observations, m.records, m.reduced_residual, m.fits
        );
        let p = &m.parameters;
        for (nm, e, t) in [
            ("R", &p.restitution, r),
            ("f0", &p.natural_frequency_hz, f),
            ("beta", &p.damping_ratio, b),
            ("xst", &p.static_deflection_m, 5e-4),
        ] {
            if let Some(e) = e {
                if let (Some(v), Some(s)) = (e.value, e.standard_error) {
                    println!(
                        "   {nm} {v:.6} se {s:.2e} dev {:.2e} rel {:.3}% z {:.2} {:?}",
                        v - t,
                        100.0 * (v / t - 1.0),
                        (v - t) / s,
                        e.status
                    );
                } else {
                    println!("   {nm} {:?}", e);
                }
            }
        }
        if std::env::var("FUR").is_ok() {
            for (k, e) in &m.further {
                println!("   {k} {:?} {:?}", e.value, e.standard_error);
            }
        }
        for r in &m.remarks {
            println!("   {r}");
        }
    };
    for (k, m) in &out.methods {
        show(k, m);
    }
    show("JOINT", &out.joint);
    println!("{:?}\n{:?}", out.verdict, out.agreement.summary);
    for (a, b) in &out.left_out {
        println!("left out {a}: {b}");
    }
}
