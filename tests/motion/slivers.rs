//! Bodies ten thousand to a million times as long as thick, beside bodies of other sizes: what a cast says is proved.

use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastConfig, CastOutcome, Motion, verify_cast};
use swiftprox::shape::Shape;
use testkit::shapes::hull;

use crate::{moving, run};

/// A needle of ten thousand times its thickness that flies at a tetrahedron. Cause: a climb on slivers ended below the farthest
/// vertex, as single precision has it rise no more, and what its edges proved was half a body short; so a sweep found no step
/// although the distance told of room. Of 90,000 casts of such bodies the check refused 31, this one among them.
#[test]
fn a_climb_that_ends_early_ends_no_proof() {
    let needle = [
        [732.0731145341155, -232.24911112071987, 1073.8401690059839],
        [1206.7466684883411, -382.8384444659082, 1770.1167721142442],
        [165.09836589943873, -52.37721107527332, 242.17619342637335],
        [1135.0547448997495, -360.09466105057635, 1664.9553186512126],
        [999.8361708821941, -317.1966335529947, 1466.6110374886896],
        [-1921.6659157002493, 609.6454445296462, -2818.794954208385],
        [-2314.549430536963, 734.2866280286605, -3395.096808944976],
        [873.5053067894626, -277.1172340227803, 1281.300110535406],
        [1595.8598188060516, -506.2839934203049, 2340.8861840890577],
        [-2131.626110563846, 676.2548465237763, -3126.772896560128],
        [2449.5202009421846, -777.106840740696, 3593.077741284011],
        [-1756.5442542777735, 557.260292618935, -2576.586531308741],
    ];
    let tetrahedron = [
        [6849.933101737915, -5573.827137411647, -5144.971882822668],
        [6849.9553145705895, -5574.768626957076, -5144.15335750436],
        [6850.666859169217, -5573.713042734045, -5144.619767809879],
        [6851.014469537635, -5573.940043584941, -5144.518514554919],
    ];
    let still = Motion::Fixed(Pose {
        rows: [
            [0.508802056312561, -0.38543251156806946, -0.7697806358337402, 0.0],
            [-0.5362347960472107, 0.5576286911964417, -0.6336422562599182, 0.0],
            [0.6734781265258789, 0.7351816296577454, 0.07704029232263565, 0.0],
        ],
    });
    let start = Pose {
        rows: [
            [-0.44429401109264516, 0.731359620356512, 0.5174127341096643, 10611.12810378217],
            [-0.11316001097444123, -0.6187340008245289, 0.7774079033172742, -976.5345037723264],
            [0.8887056000855583, 0.2868472449498857, 0.3576604736915857, 4101.08353119596],
        ],
    };
    let flight = crate::straight(start, [-1651.9835116094607, 572.0817510137103, -1843.892288886445]);
    let shapes = [hull(&tetrahedron.map(Vector::from)), hull(&needle.map(Vector::from))];
    check_hit(&shapes, &still, &flight);
}

/// A point that flies at a bar a million times as long as thick. Cause: that they are deeper in each other than the poses are
/// rounded was known by four differences of vertices; the check asked for a depth, whose lower end is 0 there. It refused 4 of
/// 90,000.
#[test]
fn four_differences_prove_a_hit() {
    let (long, thin) = (574.289794921875, 0.000569205149076879);
    let bar = testkit::models::cuboid([long, thin, thin]).unwrap().vertices;
    let still = Motion::Fixed(Pose {
        rows: [
            [0.8465951667270761, 0.14206856635109444, -0.5129260630239985, 277.1400760390421],
            [0.20616424567563235, 0.8009464861540267, 0.5621218997001584, 67.54415692934916],
            [0.4906861802408457, -0.5816366982683109, 0.6487879691690421, 161.05898957020244],
        ],
    });
    let start = Pose {
        rows: [
            [0.9923778593961968, -0.007872178546392671, 0.13677757040406288, -12.800445289603637],
            [0.038617468625330956, 0.9712865927378012, -0.24046960416837473, 13.279936993671996],
            [-0.12826331261782975, 0.24098031758552343, 0.960658516141107, 10.81798299831808],
        ],
    };
    let turn = [5.506429581376485e-7, 1.634628810651435e-6, 4.075723035723621e-8];
    let flight = crate::screw(start, [25.600890579207274, -26.55987398734399, -21.63596599663616], turn);
    let point = Vector::new(-0.4675779697775684, -0.009340989061166696, 0.11540474354087768);
    check_hit(&[hull(&[point]), hull(&bar)], &flight, &still);
}

fn check_hit(shapes: &[Shape; 2], first: &Motion, second: &Motion) {
    let config = CastConfig { time_tolerance: 1e-6, step_budget: 3_000, ..CastConfig::default() };
    let pair = moving([&shapes[0], &shapes[1]], [first, second]);
    let answer = run(pair, &config);
    assert_eq!((answer.outcome, verify_cast(pair, &config, &answer)), (CastOutcome::Hit, Ok(())), "{answer:?}");
}

/// A speck that stays beside a beam 5e14 long. Cause: a clearance comes from steps that were chosen for `max_distance`; the check
/// chose its own for the clearance, and found none.
#[test]
fn a_clearance_is_proved_by_the_steps_of_the_cast() {
    let tiny = 0.0009765625;
    let speck = [
        [0.0, 0.0, 0.0],
        [0.0009765624999999993, 0.0009765624999999987, 0.000976562499999998],
        [0.0009765624999999974, 0.0009765624999999967, 0.0009765624999999961],
        [0.0009765624999999993, 0.0009765624999999987, tiny],
    ];
    let beam = [
        [0.9999999999999953, 0.9999999999999947, 0.999999999999994],
        [18.0, 17.99999999999998, 17.999999999999957],
        [17.999999999999872, 17.99999999999985, 0.0],
        [0.0, 2.125, 3.875],
        [0.5, 3.75, 17.0],
        [0.0, 1.0000000000000016, 0.875],
        [2.75, -2.75, 2.75],
        [0.8750000000000016, 492581209243648.9, 0.0],
    ];
    let turned = |[x, y, z]: [f64; 3]| {
        Motion::Fixed(Pose {
            rows: [
                [0.9999999996965698, -2.384204262647436e-5, -6.198172507459425e-6, x],
                [2.3841673144252152e-5, 0.9999999979394261, -5.9604718609852587e-5, y],
                [6.199593592929468e-6, 5.96045708169637e-5, 0.9999999982044301, z],
            ],
        })
    };
    let motions = [
        turned([0.999999999999999, -0.999999999999999, -32.0]),
        turned([56.00128423896015, -11.061086100140827, -42.93717892093776]),
    ];
    let shapes = [hull(&speck.map(Vector::from)), hull(&beam.map(Vector::from))];
    let config = CastConfig::default();
    let bodies = moving([&shapes[0], &shapes[1]], [&motions[0], &motions[1]]);
    let answer = run(bodies, &config);
    assert_eq!(answer.outcome, CastOutcome::Free, "{answer:?}");
    verify_cast(bodies, &config, &answer).unwrap_or_else(|error| panic!("{error}: {answer:?}"));
}
